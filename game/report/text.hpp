#pragma once

#include <string>
#include <string_view>

// Numbers and text in reports, independent of the locale.
namespace handhold {

// The shortest text that round-trips to the same double (at most 17 digits): equal text means equal
// bits. "nan", "inf" or "-inf" if not finite.
void append_number(std::string& text, double value);
// With a fixed number of decimals; as append_number if not finite.
void append_fixed(std::string& text, double value, int decimals);
// For people: at least four significant digits, "12 346", "0.0416", or "−1.25×10⁻⁷" with three.
// UTF-8.
std::string format_figure(double value);
// "10⁻⁶"
std::string format_power_of_ten(int exponent);

// A CSV cell (RFC 4180): quoted if it holds a comma, a quote or a line break.
std::string quote_csv(std::string_view cell);
// Escapes text for an HTML element or a quoted attribute.
std::string escape_html(std::string_view text);

}  // namespace handhold
