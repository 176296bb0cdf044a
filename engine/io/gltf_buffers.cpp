#include "engine/io/gltf_buffers.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "engine/core/text_file.hpp"

namespace handhold::gltf {
namespace {

constexpr std::string_view k_data_scheme = "data:";

// The value of each character as a base64 digit (RFC 4648); k_no_digit for other characters.
constexpr std::uint8_t k_no_digit = 64;
constexpr std::array<std::uint8_t, 256> k_base64_values = [] {
    constexpr std::string_view k_digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(k_no_digit);
    for (std::size_t i = 0; i < k_digits.size(); ++i) {
        values[static_cast<unsigned char>(k_digits[i])] = static_cast<std::uint8_t>(i);
    }
    return values;
}();

// nullopt if the text is not base64.
std::optional<std::string> decode_base64(std::string_view text) {
    while (!text.empty() && text.back() == '=') {
        text.remove_suffix(1);
    }
    if (text.size() % 4 == 1) {
        return std::nullopt;
    }
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t value = k_base64_values[static_cast<unsigned char>(text[i])];
        if (value == k_no_digit) {
            return std::nullopt;
        }
        bits = bits << 6U | value;
        if (i % 4 != 0) {  // four digits of 6 bits give three bytes
            bytes += static_cast<char>(bits >> (2 * (3 - i % 4)) & 0xFFU);
        }
    }
    return bytes;
}

// Decodes percent escapes (RFC 3986). A percent sign that begins none stands for itself: many
// exporters write file names as they are.
std::string decode_percent(std::string_view uri) {
    const auto digit_of = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_escape = uri[i] == '%' && i + 2 < uri.size();
        const int high = is_escape ? digit_of(uri[i + 1]) : -1;
        const int low = is_escape ? digit_of(uri[i + 2]) : -1;
        if (high < 0 || low < 0) {
            text += uri[i];
            continue;
        }
        text += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return text;
}

// The path of a name below `folder`. nullopt for an absolute path, a scheme, or a path that leaves
// the folder.
std::optional<std::filesystem::path> path_below(const std::filesystem::path& folder,
                                                const std::string& name) {
    if (name.empty() || name.find('\0') != std::string::npos ||
        name.find("://") != std::string::npos) {
        return std::nullopt;
    }
    const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
    if (relative.has_root_path() || relative.begin()->string() == "..") {
        return std::nullopt;
    }
    return folder / relative;
}

// The file that a relative URI names below `folder`; nullopt for an absolute path, a scheme, or a
// path that leaves the folder. Exporters that do not escape names write "a%20b.bin" for a file with
// that very name: the unescaped name comes first.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& folder,
                                                const std::string& uri) {
    const std::optional<std::filesystem::path> decoded = path_below(folder, decode_percent(uri));
    const std::optional<std::filesystem::path> literal = path_below(folder, uri);
    std::error_code ignored;
    const bool is_literal = !(decoded && std::filesystem::exists(*decoded, ignored)) && literal &&
                            std::filesystem::exists(*literal, ignored);
    return is_literal ? literal : decoded;
}

Result<std::string> read_data_uri(std::string_view uri, std::uint64_t max_bytes) {
    constexpr std::string_view k_encoding = ";base64";
    const auto refuse = [](std::string expected) { return FileError{"", "", std::move(expected)}; };
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(k_encoding)) {
        return refuse("expected a data URI in base64");
    }
    const std::string text = decode_percent(uri.substr(comma + 1));  // "%3D" at the end, mostly
    if (text.size() / 4 * 3 > max_bytes) {
        return refuse("expected fewer bytes in all buffers");
    }
    std::optional<std::string> bytes = decode_base64(text);
    if (!bytes) {
        return refuse("expected a data URI in base64");
    }
    return *std::move(bytes);
}

}  // namespace

bool Buffers::load(const Model& model, const std::filesystem::path& path, Refusal& refusal) {
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    owned_.assign(model.buffers.size(), {});  // never resized: bytes_ points into its strings
    bytes_.assign(model.buffers.size(), {});
    std::uint64_t budget = k_max_file_bytes;
    for (std::size_t i = 0; i < model.buffers.size(); ++i) {
        const Buffer& buffer = model.buffers[i];
        const std::string place = pointer("buffers", static_cast<int>(i));
        if (buffer.is_fallback) {
            continue;
        }
        if (buffer.uri.empty()) {
            bytes_[i] = model.binary.substr(0, buffer.bytes);  // the parser checked its length
            continue;
        }
        const bool is_data = std::string_view(buffer.uri).starts_with(k_data_scheme);
        const std::optional<std::filesystem::path> file =
            is_data || path.empty() ? std::nullopt : file_below(folder, buffer.uri);
        if (!is_data && !file) {
            return refusal.refuse(
                place + "/uri",
                std::string(path.empty() ? "expected a data URI or a .glb, as the file is in memory"
                                         : "expected a data URI or a file in this folder") +
                    ", found " + printable(buffer.uri));
        }
        Result<std::string> bytes =
            is_data ? read_data_uri(buffer.uri, budget) : read_file(*file, budget);
        if (!bytes) {
            return refusal.refuse(place + "/uri", (is_data ? "" : printable(buffer.uri) + ": ") +
                                                      bytes.error().expected);
        }
        owned_[i] = std::move(bytes.value());
        budget -= owned_[i].size();
        if (owned_[i].size() < buffer.bytes) {
            return refusal.refuse(place + "/byteLength",
                                  "expected at most the " + std::to_string(owned_[i].size()) +
                                      " bytes of " +
                                      (is_data ? "the data URI" : printable(buffer.uri)) +
                                      ", found " + std::to_string(buffer.bytes));
        }
        bytes_[i] = std::string_view(owned_[i]).substr(0, buffer.bytes);
    }
    return true;
}

}  // namespace handhold::gltf
