#include "engine/core/result.hpp"

#include "engine/core/printable.hpp"

namespace handhold {

std::string FileError::message() const {
    // Limits of the parts of a line. At most k_max_quoted characters come from the file: the place,
    // and the text after "found".
    constexpr std::size_t k_max_place = 80;
    constexpr std::size_t k_max_expected = 600;
    constexpr std::string_view k_found = ", found ";
    const std::size_t found = expected.find(k_found);
    std::string line = printable(file) + ": ";
    if (!place.empty()) {
        line += printable(place, k_max_place) + ": ";
    }
    line += printable(std::string_view(expected).substr(0, found), k_max_expected);
    if (found != std::string::npos) {
        line += printable(std::string_view(expected).substr(found), k_max_quoted - k_max_place);
    }
    return line;
}

}  // namespace handhold
