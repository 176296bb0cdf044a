#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

// Validators of command-line values that CLI11 lacks.
namespace handhold {

// A number in [low, high], not NaN. CLI::Range accepts NaN.
inline CLI::Validator number_in(double low, double high) {
    const std::string range =
        "[" + CLI::detail::to_string(low) + ", " + CLI::detail::to_string(high) + "]";
    return {[=](std::string& text) {
                double value = 0.0;
                const bool is_in =
                    CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
                return is_in ? std::string() : "expected a number in " + range + ", found " + text;
            },
            "FLOAT in " + range};
}

// A whole number of digits only. (strtoull would read "-1" as 2^64 - 1.)
inline CLI::Validator whole_number() {
    return {[](std::string& text) {
                const bool is_whole =
                    !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
                return is_whole ? std::string() : "expected a whole number from 0, found " + text;
            },
            "UINT"};
}

// Adds an option that takes one of the words of `values`. Help shows the words alone.
template <typename Enum>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Enum& chosen,
                        const std::map<std::string, Enum>& values, const std::string& help) {
    std::string words;
    for (const auto& [word, value] : values) {
        words += (words.empty() ? "" : "|") + word;
    }
    const auto read = [=](std::string& text) {
        const auto found = values.find(text);
        if (found == values.end()) {
            return "expected " + words + ", found " + text;
        }
        text = std::to_string(static_cast<int>(found->second));
        return std::string();
    };
    return app.add_option(name, chosen, help)
        ->transform(CLI::Validator(read, ""))
        ->type_name(words);
}

}  // namespace handhold
