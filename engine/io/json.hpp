#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

// Typed reading of JSON without a test after every value. The document keeps its first error: a
// value that is absent, of the wrong type or out of range. A bad value reads as zero of the
// requested type. The caller checks JsonDocument::failed() once, at the end.
namespace handhold {

// The range of a number, [low, high] or, with `above_low`, (low, high].
struct NumberRange {
    double low = -1e12;
    double high = 1e12;
    bool above_low = false;
};
constexpr NumberRange k_positive = {0.0, 1e12, true};
constexpr NumberRange k_not_negative = {0.0, 1e12, false};
constexpr NumberRange k_unit_interval = {0.0, 1.0, false};

class JsonDocument;

// A value of a document and its JSON pointer. A value whose key is absent does not exist. Valid as
// long as the document.
class JsonValue {
  public:
    bool exists() const { return node_ != nullptr; }
    bool is_object() const;
    bool is_array() const;
    bool is_text() const;
    bool is_number() const;

    // A member of an object.
    JsonValue operator[](std::string_view key) const;
    // The elements of an array. If the array is absent, optional_items is empty; items is an error.
    std::vector<JsonValue> items() const;
    std::vector<JsonValue> optional_items() const;
    // The members of an object, sorted by key. An absent object is empty.
    std::vector<std::pair<std::string, JsonValue>> optional_members() const;
    // Any key that is not listed is an error.
    void allow_only(std::initializer_list<std::string_view> keys) const;
    void allow_only(std::span<const std::string_view> keys) const;

    double number(const NumberRange& range = {}) const;
    std::int64_t integer(std::int64_t low, std::int64_t high) const;  // no fraction, no exponent
    bool flag() const;
    std::string text() const;  // not empty
    Vec3 vector(const NumberRange& range = {}) const;
    // A quaternion x, y, z, w. Its length must be within 1e-2 of 1; the result is normalised.
    Quat rotation() const;

    // Like the readers above, but an absent value reads as `fallback`. A null is not an absent
    // value.
    double number_or(double fallback, const NumberRange& range = {}) const;
    bool flag_or(bool fallback) const;
    std::string text_or(std::string fallback) const;
    Vec3 vector_or(const Vec3& fallback, const NumberRange& range = {}) const;
    Quat rotation_or(const Quat& fallback) const;
    // For labels: never an error. Empty if the value is absent or not a text.
    std::string label() const;

    // The value as JSON text for another parser. If it is an object, its members `keys` are left
    // out.
    std::string dump_without(std::initializer_list<std::string_view> keys) const;

    const std::string& pointer() const { return pointer_; }
    // Sets the document's error to "expected <expected>, found <this value>" if it has none.
    void refuse(const std::string& expected) const;

  private:
    friend class JsonDocument;
    struct Document;
    JsonValue(Document* document, const nlohmann::json* node, std::string pointer);

    Document* document_;
    const nlohmann::json* node_;
    std::string pointer_;
};

// A parsed document and the first error found in it.
class JsonDocument {
  public:
    // Errors: malformed JSON (the message gives line and column), a key twice in one object, a
    // number out of a double's range, text that is not UTF-8, more than 64 levels of nesting.
    // `file` is used in messages.
    static Result<JsonDocument> parse(std::string_view text, const std::string& file);
    static Result<JsonDocument> load(const std::filesystem::path& path);

    JsonDocument(JsonDocument&&) noexcept;
    JsonDocument& operator=(JsonDocument&&) noexcept;
    ~JsonDocument();

    JsonValue root() const;
    bool failed() const;
    // Precondition: failed().
    const FileError& error() const;

  private:
    JsonDocument();
    std::unique_ptr<JsonValue::Document> document_;
};

}  // namespace handhold
