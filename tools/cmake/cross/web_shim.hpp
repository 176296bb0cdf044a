#pragma once

// What our sources use of C++20's library and emscripten 3.1.6 (libc++ 13) lacks: std::bit_cast,
// the algorithms of std::ranges, and std::from_chars and std::to_chars of doubles. Included before
// every source by web.cmake; no other target sees it.
#ifdef __cplusplus
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <ranges>
#include <string>
#include <type_traits>
#include <vector>

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

// Reads like strtod in the "C" locale, without its leading spaces, plus sign and hexadecimal form.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
    const string text(first, last);
    if (text.empty() || text[0] == '+' || isspace(static_cast<unsigned char>(text[0])) ||
        text.find_first_of("xX") != string::npos) {
        return {first, errc::invalid_argument};
    }
    char* end = nullptr;
    const double read = strtod(text.c_str(), &end);
    if (end == text.c_str()) {
        return {first, errc::invalid_argument};
    }
    value = read;
    return {first + (end - text.c_str()), errc{}};
}

inline to_chars_result chars_by_printf(char* first, char* last, const char* format, int digits,
                                       double value) {
    const int count = snprintf(first, static_cast<size_t>(last - first), format, digits, value);
    return count < last - first ? to_chars_result{first + count, errc{}}
                                : to_chars_result{last, errc::value_too_large};
}
// The fewest digits that are read back as the same number.
inline to_chars_result to_chars(char* first, char* last, double value) {
    for (int digits = 1; digits < 17; ++digits) {
        const to_chars_result result = chars_by_printf(first, last, "%.*g", digits, value);
        if (result.ec != errc{} || strtod(string(first, result.ptr).c_str(), nullptr) == value) {
            return result;
        }
    }
    return chars_by_printf(first, last, "%.*g", 17, value);
}
inline to_chars_result to_chars(char* first, char* last, double value, chars_format format,
                                int precision) {
    const char* const text = format == chars_format::scientific ? "%.*e"
                             : format == chars_format::fixed    ? "%.*f"
                                                                : "%.*g";
    return chars_by_printf(first, last, text, precision, value);
}
inline to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
    for (int precision = 0; precision < 17; ++precision) {
        const to_chars_result result = to_chars(first, last, value, format, precision);
        if (result.ec != errc{} || strtod(string(first, result.ptr).c_str(), nullptr) == value) {
            return result;
        }
    }
    return to_chars(first, last, value, format, 17);
}

// Sorts of 0.5 kB for each type, where libc++'s have 4: the module is downloaded. Short ranges by
// insertion, others as a heap. std::sort and std::stable_sort find these, because they are more
// constrained than libc++'s.
template <class I, class Less>
requires true constexpr void sort(I first, I last, Less less) {
    const auto count = last - first;
    if (count <= 16) {
        for (auto end = first; end != last; ++end) {
            auto value = std::move(*end);
            auto at = end;
            for (; at != first && less(value, at[-1]); --at) {
                *at = std::move(at[-1]);
            }
            *at = std::move(value);
        }
        return;
    }
    const auto place = [&](auto root, auto end, auto value) {
        for (auto child = 2 * root + 1; child < end; child = 2 * root + 1) {
            child += child + 1 < end && less(first[child], first[child + 1]);
            if (!less(value, first[child])) {
                break;
            }
            first[root] = std::move(first[child]);
            root = child;
        }
        first[root] = std::move(value);
    };
    for (auto root = count / 2; root-- > 0;) {
        auto value = std::move(first[root]);
        place(root, count, std::move(value));
    }
    for (auto end = count; --end > 0;) {
        auto value = std::move(first[end]);
        first[end] = std::move(first[0]);
        place(decltype(end){0}, end, std::move(value));
    }
}
template <class I>
requires true constexpr void sort(I first, I last) { sort(first, last, less<>{}); }
// Merges runs of doubled length.
template <class I, class Less>
requires true constexpr void stable_sort(I first, I last, Less less) {
    const auto count = last - first;
    vector<remove_cvref_t<decltype(*first)>> merged;
    for (auto run = decltype(count){1}; run < count; run = 2 * run) {
        merged.clear();
        for (auto begin = decltype(run){0}; begin < count; begin += 2 * run) {
            const auto middle = std::min(begin + run, count);
            const auto end = std::min(middle + run, count);
            for (auto a = begin, b = middle; a < middle || b < end;) {
                const bool takes_second = a == middle || (b < end && less(first[b], first[a]));
                merged.push_back(std::move(first[takes_second ? b++ : a++]));
            }
        }
        std::move(merged.begin(), merged.end(), first);
    }
}
template <class I>
requires true constexpr void stable_sort(I first, I last) { stable_sort(first, last, less<>{}); }

namespace ranges {

// A comparison of projections.
template <class Compare, class Projection>
auto projected_less(Compare& compare, Projection& projection) {
    return [&](auto&& a, auto&& b) -> bool {
        return std::invoke(compare, std::invoke(projection, a), std::invoke(projection, b));
    };
}
template <class Predicate, class Projection>
auto projected_test(Predicate& predicate, Projection& projection) {
    return [&](auto&& a) -> bool { return std::invoke(predicate, std::invoke(projection, a)); };
}

#define HH_TEST_ALGORITHM(name)                                     \
    template <class R, class F, class P = identity>                 \
    constexpr auto name(R&& range, F test, P projection = {}) {     \
        return std::name(std::begin(range), std::end(range),        \
                         ranges::projected_test(test, projection)); \
    }
#define HH_ORDER_ALGORITHM(name)                                        \
    template <class R, class C = ranges::less, class P = identity>      \
    constexpr auto name(R&& range, C compare = {}, P projection = {}) { \
        return std::name(std::begin(range), std::end(range),            \
                         ranges::projected_less(compare, projection));  \
    }
HH_TEST_ALGORITHM(all_of)
HH_TEST_ALGORITHM(any_of)
HH_TEST_ALGORITHM(none_of)
HH_TEST_ALGORITHM(count_if)
HH_TEST_ALGORITHM(find_if)
HH_ORDER_ALGORITHM(sort)
HH_ORDER_ALGORITHM(stable_sort)
HH_ORDER_ALGORITHM(is_sorted)
HH_ORDER_ALGORITHM(max_element)
HH_ORDER_ALGORITHM(make_heap)
HH_ORDER_ALGORITHM(push_heap)
HH_ORDER_ALGORITHM(pop_heap)
#undef HH_TEST_ALGORITHM
#undef HH_ORDER_ALGORITHM

template <class R, class I, class C = ranges::less, class P = identity>
constexpr void nth_element(R&& range, I nth, C compare = {}, P projection = {}) {
    std::nth_element(std::begin(range), nth, std::end(range),
                     ranges::projected_less(compare, projection));
}
template <class R, class T, class P = identity>
constexpr auto find(R&& range, const T& value, P projection = {}) {
    return std::find_if(std::begin(range), std::end(range),
                        [&](auto&& x) -> bool { return std::invoke(projection, x) == value; });
}
template <class R, class T, class P = identity>
constexpr auto count(R&& range, const T& value, P projection = {}) {
    return std::count_if(std::begin(range), std::end(range),
                         [&](auto&& x) -> bool { return std::invoke(projection, x) == value; });
}
template <class R, class T, class C = ranges::less, class P = identity>
constexpr auto lower_bound(R&& range, const T& value, C compare = {}, P projection = {}) {
    return std::lower_bound(std::begin(range), std::end(range), value,
                            [&](auto&& x, const T& y) -> bool {
                                return std::invoke(compare, std::invoke(projection, x), y);
                            });
}
template <class A, class B, class F = ranges::equal_to>
constexpr bool equal(A&& a, B&& b, F test = {}) {
    return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), test);
}
template <class R>
constexpr auto max(R&& range) {
    return *std::max_element(std::begin(range), std::end(range));
}
template <class R, class O>
constexpr O copy(R&& range, O out) {
    return std::copy(std::begin(range), std::end(range), out);
}
template <class R, class O, class F, class P = identity>
constexpr O copy_if(R&& range, O out, F test, P projection = {}) {
    return std::copy_if(std::begin(range), std::end(range), out,
                        ranges::projected_test(test, projection));
}
template <class R, class T>
constexpr void fill(R&& range, const T& value) {
    std::fill(std::begin(range), std::end(range), value);
}
template <class R, class F>
constexpr void for_each(R&& range, F function) {
    for (auto&& x : range) {
        std::invoke(function, x);
    }
}
template <class R, class T>
constexpr void replace(R&& range, const T& from, const T& to) {
    std::replace(std::begin(range), std::end(range), from, to);
}
template <class R>
constexpr void reverse(R&& range) {
    std::reverse(std::begin(range), std::end(range));
}
template <class A, class B, class O>
constexpr O set_union(A&& a, B&& b, O out) {
    return std::set_union(std::begin(a), std::end(a), std::begin(b), std::end(b), out);
}
template <class R, class O, class F>
constexpr O transform(R&& range, O out, F function) {
    for (auto&& x : range) {
        *out++ = std::invoke(function, x);
    }
    return out;
}

// Algorithms on two ranges.
template <class A, class B, class O, class F>
requires requires(B& b) { std::begin(b); }
constexpr O transform(A&& a, B&& b, O out, F function) {
    return std::transform(std::begin(a), std::end(a), std::begin(b), out, function);
}
template <class A, class B, class O>
constexpr O set_symmetric_difference(A&& a, B&& b, O out) {
    return std::set_symmetric_difference(std::begin(a), std::end(a), std::begin(b), std::end(b),
                                         out);
}

}  // namespace ranges
}  // namespace std
#endif
