#pragma once

#include <string>
#include <string_view>

// Numbers and text as reports write them, whatever the locale.
namespace handhold {

// As few digits as bring the same double back (at most 17): equal text is equal bits. "nan", "inf",
// "-inf" for what is not finite.
void append_number(std::string& text, double value);
// With so many digits after the point; as append_number where it is not finite.
void append_fixed(std::string& text, double value, int decimals);
// For people: at least four significant digits, "12 346", "0.0416", "−1.25×10⁻⁷" with three. UTF-8.
std::string format_figure(double value);
// "10⁻⁶"
std::string format_power_of_ten(int exponent);

// A CSV cell (RFC 4180): in quotes where it holds a comma, a quote or a line break.
std::string quote_csv(std::string_view cell);
// Text inside of an HTML element or a quoted attribute.
std::string escape_html(std::string_view text);

}  // namespace handhold
