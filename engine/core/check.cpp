#include "engine/core/check.hpp"

#include <cstdio>

namespace handhold {

void fail_precondition(const char* function, const char* what, const std::string& value) {
    throw PreconditionError(std::string(function) + ": " + what + " (value " + value + ")");
}

std::string number_text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", value);
    return digits;
}

}  // namespace handhold
