#include "engine/io/json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/core/text_file.hpp"
#include "engine/io/json_tree.hpp"

namespace handhold {

using Json = nlohmann::json;

// nlohmann's destructor allocates for nested documents; json_tree.hpp limits the depth.
struct JsonValue::Document {  // NOLINT(bugprone-exception-escape)
    Json root;
    std::string file;
    std::optional<FileError> error;
};

namespace {

std::string write_number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", value);
    return digits;
}

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
            return shorten_json(node->dump(-1, ' ', false, Json::error_handler_t::replace));
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
    return {document_, member, append_json_key(pointer_, key)};
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
        result.emplace_back(
            member.key(), JsonValue(document_, &*member, append_json_key(pointer_, member.key())));
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
            document_->error = FileError{document_->file, append_json_key(pointer_, member.key()),
                                         "expected one of the keys " + known + ", found \"" +
                                             shorten_json(member.key()) + "\""};
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
    if (const auto error = parse_json_tree(text, file, result.document_->root)) {
        return *error;
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
