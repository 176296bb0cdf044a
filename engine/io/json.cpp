#include "engine/io/json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/io/text_file.hpp"

namespace handhold {

using Json = nlohmann::json;

// nlohmann's destructor allocates for nested documents; k_max_depth limits how much.
struct JsonValue::Document {  // NOLINT(bugprone-exception-escape)
    Json root;
    std::string file;
    std::optional<FileError> error;
};

namespace {

constexpr std::size_t k_max_depth = 64;
constexpr std::size_t k_shown_characters = 60;

std::string write_number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", value);
    return digits;
}

std::string shorten(std::string_view text) { return printable(text, k_shown_characters); }

std::string describe(const Json* node) {
    if (node == nullptr) {
        return "nothing";
    }
    switch (node->type()) {
        case Json::value_t::object:
            return "an object";
        case Json::value_t::array:
            return "an array of " + std::to_string(node->size());
        default:
            return shorten(node->dump(-1, ' ', false, Json::error_handler_t::replace));
    }
}

std::string describe(const NumberRange& range) {
    const NumberRange any;
    if (range.low == any.low && range.high == any.high) {
        return "a number";
    }
    if (range.high == any.high) {
        return std::string("a number ") + (range.above_low ? "above " : "not below ") +
               write_number(range.low);
    }
    return std::string("a number in ") + (range.above_low ? "(" : "[") + write_number(range.low) +
           ", " + write_number(range.high) + "]";
}

std::string append_key(const std::string& pointer, std::string_view key) {
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
    // Only binary formats call this.
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
            error_ = FileError{file_, pointer(),
                               "expected every key once, found \"" + shorten(name) + "\" twice"};
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
                result = append_key(result, keys_[i + 1]);
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

JsonValue::JsonValue(Document* document, const Json* node, std::string pointer)
    : document_(document), node_(node), pointer_(std::move(pointer)) {}

bool JsonValue::is_object() const { return exists() && node_->is_object(); }
bool JsonValue::is_array() const { return exists() && node_->is_array(); }
bool JsonValue::is_text() const { return exists() && node_->is_string(); }
bool JsonValue::is_number() const { return exists() && node_->is_number(); }

void JsonValue::refuse(const std::string& expected) const {
    if (!document_->error) {
        document_->error = FileError{document_->file, pointer_,
                                     "expected " + expected + ", found " + describe(node_)};
    }
}

JsonValue JsonValue::operator[](std::string_view key) const {
    const Json* member = nullptr;
    if (!is_object()) {
        refuse("an object");
    } else if (const auto found = node_->find(key); found != node_->end()) {
        member = &*found;
    }
    return {document_, member, append_key(pointer_, key)};
}

std::vector<JsonValue> JsonValue::items() const {
    std::vector<JsonValue> result;
    if (!exists() || !node_->is_array()) {
        refuse("an array");
        return result;
    }
    result.reserve(node_->size());
    for (const Json& item : *node_) {
        result.push_back(
            JsonValue(document_, &item, pointer_ + "/" + std::to_string(result.size())));
    }
    return result;
}

std::vector<JsonValue> JsonValue::optional_items() const {
    return exists() ? items() : std::vector<JsonValue>();
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::optional_members() const {
    std::vector<std::pair<std::string, JsonValue>> result;
    if (!exists()) {
        return result;
    }
    if (!is_object()) {
        refuse("an object");
        return result;
    }
    result.reserve(node_->size());
    for (auto member = node_->begin(); member != node_->end(); ++member) {
        result.emplace_back(member.key(),
                            JsonValue(document_, &*member, append_key(pointer_, member.key())));
    }
    return result;
}

void JsonValue::allow_only(std::initializer_list<std::string_view> keys) const {
    allow_only(std::span(keys.begin(), keys.size()));
}

void JsonValue::allow_only(std::span<const std::string_view> keys) const {
    if (!is_object()) {
        refuse("an object");
        return;
    }
    for (auto member = node_->begin(); member != node_->end(); ++member) {
        if (std::find(keys.begin(), keys.end(), member.key()) != keys.end()) {
            continue;
        }
        std::string known;
        for (const std::string_view key : keys) {
            known += (known.empty() ? "" : ", ") + std::string(key);
        }
        if (!document_->error) {
            document_->error = FileError{
                document_->file, append_key(pointer_, member.key()),
                "expected one of the keys " + known + ", found \"" + shorten(member.key()) + "\""};
        }
        return;
    }
}

double JsonValue::number(const NumberRange& range) const {
    if (exists() && node_->is_number()) {
        const double value = node_->get<double>();
        const bool low_ok = range.above_low ? value > range.low : value >= range.low;
        if (low_ok && value <= range.high) {
            return value;
        }
    }
    refuse(describe(range));
    return 0.0;
}

std::int64_t JsonValue::integer(std::int64_t low, std::int64_t high) const {
    // An unsigned value of 2^63 or more would become negative.
    if (exists() && node_->is_number_integer() &&
        !(node_->is_number_unsigned() && node_->get<std::uint64_t>() > INT64_MAX)) {
        const std::int64_t value = node_->get<std::int64_t>();
        if (value >= low && value <= high) {
            return value;
        }
    }
    refuse("an integer in [" + std::to_string(low) + ", " + std::to_string(high) + "]");
    return 0;
}

bool JsonValue::flag() const {
    if (!exists() || !node_->is_boolean()) {
        refuse("true or false");
        return false;
    }
    return node_->get<bool>();
}

std::string JsonValue::text() const {
    if (!is_text() || node_->get_ref<const std::string&>().empty()) {
        refuse("a text that is not empty");
        return {};
    }
    return node_->get<std::string>();
}

Vec3 JsonValue::vector(const NumberRange& range) const {
    if (!exists() || !node_->is_array() || node_->size() != 3) {
        refuse("an array of 3 numbers");
        return Vec3::Zero();
    }
    const std::vector<JsonValue> parts = items();
    return {parts[0].number(range), parts[1].number(range), parts[2].number(range)};
}

Quat JsonValue::rotation() const {
    constexpr double k_length_tolerance = 1e-2;  // allows components of four decimals
    if (!exists() || !node_->is_array() || node_->size() != 4) {
        refuse("a quaternion: an array of 4 numbers x, y, z, w");
        return Quat::Identity();
    }
    const std::vector<JsonValue> parts = items();
    const Quat value(parts[3].number(), parts[0].number(), parts[1].number(), parts[2].number());
    if (std::abs(value.norm() - 1.0) > k_length_tolerance) {
        refuse("a quaternion of length 1, not " + write_number(value.norm()));
        return Quat::Identity();
    }
    // A quaternion of unit length up to rounding is not normalised, so that writing and reading it
    // is lossless.
    constexpr double k_rounding = 1e-15;
    return std::abs(value.squaredNorm() - 1.0) <= k_rounding ? value : value.normalized();
}

double JsonValue::number_or(double fallback, const NumberRange& range) const {
    return exists() ? number(range) : fallback;
}
bool JsonValue::flag_or(bool fallback) const { return exists() ? flag() : fallback; }
std::string JsonValue::text_or(std::string fallback) const {
    return exists() ? text() : std::move(fallback);
}
Vec3 JsonValue::vector_or(const Vec3& fallback, const NumberRange& range) const {
    return exists() ? vector(range) : fallback;
}
Quat JsonValue::rotation_or(const Quat& fallback) const { return exists() ? rotation() : fallback; }

std::string JsonValue::label() const {
    return is_text() ? node_->get<std::string>() : std::string();
}

std::string JsonValue::dump_without(std::initializer_list<std::string_view> keys) const {
    Json copy = exists() ? *node_ : Json();
    for (const std::string_view key : keys) {
        if (copy.is_object()) {
            copy.erase(std::string(key));
        }
    }
    return copy.dump();
}

JsonDocument::JsonDocument() : document_(std::make_unique<JsonValue::Document>()) {}
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

Result<JsonDocument> JsonDocument::parse(std::string_view text, const std::string& file) {
    JsonDocument result;
    result.document_->file = file;
    TreeBuilder builder(result.document_->root, text, file);
    if (!Json::sax_parse(text, &builder)) {
        return builder.error().value_or(FileError{file, "", "expected JSON"});
    }
    return result;
}

Result<JsonDocument> JsonDocument::load(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    return parse(text.value(), path.string());
}

JsonValue JsonDocument::root() const { return {document_.get(), &document_->root, ""}; }
bool JsonDocument::failed() const { return document_->error.has_value(); }
const FileError& JsonDocument::error() const {
    HH_CHECK(failed(), "no error", 0);
    return *document_->error;
}

}  // namespace handhold
