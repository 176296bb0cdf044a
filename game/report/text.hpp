#pragma once

#include <string>
#include <string_view>

// Numbers and text in reports, independent of the locale.
namespace handhold {

inline constexpr double k_mm_in_m = 1000.0;

// Appends the shortest text that round-trips to the same double (at most 17 digits), so equal texts
// mean equal bits. "nan", "inf" or "-inf" if not finite.
void append_number(std::string& text, double value);
// Appends a number with a fixed number of decimals. "nan", "inf" or "-inf" if not finite.
void append_fixed(std::string& text, double value, int decimals);
// Formats a number for people, in UTF-8: "12 346" or "0.0416" with at least four significant
// digits, without trailing zeros; "−1.25×10⁻⁷" with three.
std::string format_figure(double value);
// Formats as "10⁻⁶".
std::string format_power_of_ten(int exponent);

// A CSV cell (RFC 4180): quoted if it holds a comma, a quote or a line break.
std::string quote_csv(std::string_view cell);
// Escapes text for an HTML element or a quoted attribute.
std::string escape_html(std::string_view text);

}  // namespace handhold
