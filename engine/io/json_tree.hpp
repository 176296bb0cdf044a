#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "engine/core/result.hpp"

// Parses JSON text and names places in it. Private to engine/io/json*.
namespace handhold {

// Sets `root` to the document. The errors are those of JsonDocument::parse; `file` is used in
// messages. After an error, `root` is unspecified.
std::optional<FileError> parse_json_tree(std::string_view text, const std::string& file,
                                         nlohmann::json& root);

// The JSON pointer (RFC 6901) of the member `key` of the object at `pointer`.
std::string append_json_key(const std::string& pointer, std::string_view key);

// A text from the document as messages show it: printable, and cut off after 60 characters.
std::string shorten_json(std::string_view text);

}  // namespace handhold
