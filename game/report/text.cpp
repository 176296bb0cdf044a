#include "game/report/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace handhold {
namespace {

// The longest double in fixed notation has 309 digits before the point.
constexpr std::size_t k_max_number_length = 400;
constexpr int k_figure_digits = 4;

bool append_not_finite(std::string& text, double value) {
    if (std::isfinite(value)) {
        return false;
    }
    // Never "-nan": the sign of a NaN differs between compilers.
    text += std::isnan(value) ? "nan" : (value > 0.0 ? "inf" : "-inf");
    return true;
}

// Separates thousands of a positive number by thin spaces, from five digits before the point on.
std::string group_thousands(const std::string& digits) {
    constexpr std::size_t k_group = 3;
    const std::size_t point = std::min(digits.find('.'), digits.size());
    if (point <= k_group + 1) {
        return digits;
    }
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && i < point && (point - i) % k_group == 0) {
            text += "\u2009";
        }
        text += digits[i];
    }
    return text;
}

// Formats as "1.25×10⁻⁷". Precondition: value > 0.
std::string format_scientific(double value) {
    std::array<char, k_max_number_length> digits;
    const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::scientific, 2)
                                .ptr;
    // Uses the exponent after the library's rounding: log10 is off by one at 9.999e-8.
    const std::string_view written(digits.data(), static_cast<std::size_t>(end - digits.data()));
    const std::size_t e = written.find('e');
    int exponent = 0;
    std::from_chars(written.data() + e + 2, written.data() + written.size(), exponent);
    exponent = written[e + 1] == '-' ? -exponent : exponent;
    return std::string(written.substr(0, e)) + "×" + format_power_of_ten(exponent);
}

}  // namespace

void append_number(std::string& text, double value) {
    if (append_not_finite(text, value)) {
        return;
    }
    std::array<char, k_max_number_length> digits;
    text.append(digits.data(),
                std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append_fixed(std::string& text, double value, int decimals) {
    if (append_not_finite(text, value)) {
        return;
    }
    std::array<char, k_max_number_length> digits;
    text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                             std::chars_format::fixed, decimals)
                                   .ptr);
}

std::string format_figure(double value) {
    constexpr double k_min_fixed = 1e-3;
    constexpr double k_max_fixed = 1e9;
    constexpr int k_max_decimals = 6;
    std::string text;
    if (value == 0.0) {
        return "0";
    }
    if (append_not_finite(text, value)) {
        return text;
    }
    if (value < 0.0) {
        return "−" + format_figure(-value);
    }
    if (value < k_min_fixed || value >= k_max_fixed) {
        return format_scientific(value);
    }
    const int exponent = static_cast<int>(std::floor(std::log10(value)));
    append_fixed(text, value, std::clamp(k_figure_digits - 1 - exponent, 0, k_max_decimals));
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        text.erase(text.find_last_not_of('.') + 1);
    }
    return group_thousands(text);
}

std::string format_power_of_ten(int exponent) {
    constexpr std::array<const char*, 10> k_digits = {"⁰", "¹", "²", "³", "⁴",
                                                      "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = "10";
    for (const char digit : std::to_string(exponent)) {
        text += digit == '-' ? "⁻" : k_digits[static_cast<std::size_t>(digit - '0')];
    }
    return text;
}

std::string quote_csv(std::string_view cell) {
    if (cell.find_first_of(",\"\r\n") == std::string_view::npos) {
        return std::string(cell);
    }
    std::string text = "\"";
    for (const char c : cell) {
        text += c;
        if (c == '"') {
            text += c;
        }
    }
    return text + '"';
}

std::string escape_html(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

}  // namespace handhold
