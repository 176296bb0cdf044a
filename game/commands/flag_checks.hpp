#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

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

// "a|b|c" of the words, as help shows them.
inline std::string choices(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : "|") + word;
    }
    return text;
}

// Adds an option that takes one of the words of `values`. Help shows the words alone.
template <typename Enum>
requires std::is_enum_v<Enum> CLI::Option* add_choice(CLI::App& app, const std::string& name,
                                                      Enum& chosen,
                                                      const std::map<std::string, Enum>& values,
                                                      const std::string& help) {
    std::vector<std::string> words;
    words.reserve(values.size());
    for (const auto& [word, value] : values) {
        words.push_back(word);
    }
    const auto read = [=, shown = choices(words)](std::string& text) {
        const auto found = values.find(text);
        if (found == values.end()) {
            return "expected " + shown + ", found " + text;
        }
        text = std::to_string(static_cast<int>(found->second));
        return std::string();
    };
    return app.add_option(name, chosen, help)
        ->transform(CLI::Validator(read, ""))
        ->type_name(choices(words));
}

// The same for an option whose value is the word itself.
inline CLI::Option* add_choice(CLI::App& app, const std::string& name, std::string& chosen,
                               const std::vector<std::string>& words, const std::string& help) {
    const auto read = [=](std::string& text) {
        return std::ranges::find(words, text) != words.end()
                   ? std::string()
                   : "expected " + choices(words) + ", found " + text;
    };
    return app.add_option(name, chosen, help)
        ->check(CLI::Validator(read, ""))
        ->type_name(choices(words));
}

}  // namespace handhold
