#include "engine/core/check.hpp"

namespace handhold {

void fail_precondition(const char* function, const char* what, const std::string& value) {
    throw PreconditionError(std::string(function) + ": " + what + " (value " + value + ")");
}

}  // namespace handhold
