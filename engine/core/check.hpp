#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

// Reports violated preconditions of the API: programming errors, never bad user input.
namespace handhold {

class PreconditionError : public std::logic_error {
    using std::logic_error::logic_error;
};

// Throws PreconditionError: "at: no element for this entity (value 7)". Defined in a source file,
// so that headers compile without exceptions.
[[noreturn]] void fail_precondition(const char* function, const char* what,
                                    const std::string& value);

// A number as messages show it, with up to nine digits: "1e-09", "0.25", "160".
std::string number_text(double value);
template <typename Integer>
requires std::is_integral_v<Integer> std::string number_text(Integer value) {
    return std::to_string(value);
}

}  // namespace handhold

// Checks a precondition. It is a macro because of __func__: Clang 14 has no std::source_location.
#define HH_CHECK(condition, what, value)                                                   \
    do {                                                                                   \
        if (!(condition)) [[unlikely]] {                                                   \
            ::handhold::fail_precondition(__func__, what, ::handhold::number_text(value)); \
        }                                                                                  \
    } while (false)
