#include "engine/io/json_tree.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/core/printable.hpp"

namespace handhold {

using Json = nlohmann::json;

std::string append_json_key(const std::string& pointer, std::string_view key) {
    std::string result = pointer + "/";
    for (const char c : key) {  // RFC 6901
        if (c == '~') {
            result += "~0";
        } else if (c == '/') {
            result += "~1";
        } else {
            result += c;
        }
    }
    return result;
}

std::string shorten_json(std::string_view text) {
    constexpr std::size_t k_shown_characters = 60;
    return printable(text, k_shown_characters);
}

namespace {

constexpr std::size_t k_max_depth = 64;

// The line and column of the byte at `position`, which counts from 1: "line 3, column 7".
std::string describe_place(std::string_view text, std::size_t position) {
    const std::string_view before = text.substr(0, position == 0 ? 0 : position - 1);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t last_end = before.rfind('\n');
    const std::size_t column =
        before.size() - (last_end == std::string_view::npos ? 0 : last_end + 1) + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// Builds the tree. The library's own builder accepts duplicate keys, has no depth limit, and
// reports no position for a number out of range.
class TreeBuilder {
  public:
    TreeBuilder(Json& root, std::string_view text, std::string file)
        : root_(root), text_(text), file_(std::move(file)) {}

    bool null() { return add(Json()) != nullptr; }
    bool boolean(bool value) { return add(Json(value)) != nullptr; }
    bool number_integer(Json::number_integer_t value) { return add(Json(value)) != nullptr; }
    bool number_unsigned(Json::number_unsigned_t value) { return add(Json(value)) != nullptr; }
    bool number_float(Json::number_float_t value, const std::string& /*digits*/) {
        return add(Json(value)) != nullptr;
    }
    bool string(std::string& value) { return add(Json(std::move(value))) != nullptr; }
    // Required by the parser's interface; called only for binary formats.
    bool binary(  // NOLINT(readability-convert-member-functions-to-static)
        Json::binary_t& /*value*/) {
        return false;
    }
    bool start_object(std::size_t /*size*/) { return open(Json::object()); }
    bool start_array(std::size_t /*size*/) { return open(Json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string& name) {
        if (open_.back()->contains(name)) {
            error_ =
                FileError{file_, pointer(),
                          "expected every key once, found \"" + shorten_json(name) + "\" twice"};
            return false;
        }
        key_ = std::move(name);
        return true;
    }

    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const Json::exception& exception) {
        // Removes the beginning of the library's message: "[json.exception.parse_error.101] parse
        // error at line 1, column 2: syntax error ..." becomes "syntax error ...". describe_place
        // gives the position.
        std::string reason = exception.what();
        const std::size_t place = reason.find(": ");
        const std::size_t name = reason.find("] ");
        if (place != std::string::npos) {
            reason = reason.substr(place + 2);
        } else if (name != std::string::npos) {
            reason = reason.substr(name + 2);
        }
        error_ = FileError{file_, describe_place(text_, position),
                           "expected JSON: " + printable(reason)};
        return false;
    }

    const std::optional<FileError>& error() const { return error_; }

  private:
    // JSON pointer of the innermost open container.
    std::string pointer() const {
        std::string result;
        for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
            if (open_[i]->is_array()) {
                result += "/";
                result += std::to_string(open_[i]->size() - 1);
            } else {
                result = append_json_key(result, keys_[i + 1]);
            }
        }
        return result;
    }

    // Pointers in open_ stay valid: a container does not change while one of its children is open.
    Json* add(Json value) {
        if (open_.empty()) {
            root_ = std::move(value);
            return &root_;
        }
        Json& parent = *open_.back();
        if (parent.is_array()) {
            parent.push_back(std::move(value));
            return &parent.back();
        }
        Json& member = parent[key_];
        member = std::move(value);
        return &member;
    }

    bool open(Json value) {
        if (open_.size() >= k_max_depth) {
            error_ =
                FileError{file_, pointer(),
                          "expected at most " + std::to_string(k_max_depth) + " levels of nesting"};
            return false;
        }
        Json* container = add(std::move(value));
        open_.push_back(container);
        keys_.push_back(key_);
        return true;
    }

    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }

    Json& root_;
    std::string_view text_;
    std::string file_;
    std::vector<Json*> open_;        // containers, outermost first
    std::vector<std::string> keys_;  // key of each open container, if its parent is an object
    std::string key_;                // key of the next value
    std::optional<FileError> error_;
};

}  // namespace

std::optional<FileError> parse_json_tree(std::string_view text, const std::string& file,
                                         nlohmann::json& root) {
    TreeBuilder builder(root, text, file);
    if (!Json::sax_parse(text, &builder)) {
        return builder.error().value_or(FileError{file, "", "expected JSON"});
    }
    return std::nullopt;
}

}  // namespace handhold
