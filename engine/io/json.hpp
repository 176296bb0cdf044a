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

#include "engine/io/result.hpp"
#include "engine/math/math.hpp"

// Typed reading of JSON. Code that reads a file is a straight line without a test after every
// value: the first value that is absent, of the wrong kind or out of its range is kept as the
// document's error, everything read after it is a zero of the asked type, and whoever reads asks
// once, at the end, whether there was an error.
namespace handhold {

// Limits of a number, both included unless `above_low`.
struct NumberRange {
    double low = -1e12;
    double high = 1e12;
    bool above_low = false;  // low itself is refused
};
constexpr NumberRange k_positive = {0.0, 1e12, true};
constexpr NumberRange k_not_negative = {0.0, 1e12, false};
constexpr NumberRange k_unit_interval = {0.0, 1.0, false};

class JsonDocument;

// A place in a document: its value (none where a key is absent) and its JSON pointer. Valid as long
// as the document.
class JsonValue {
  public:
    bool exists() const { return node_ != nullptr; }
    bool is_object() const;
    bool is_array() const;
    bool is_text() const;
    bool is_number() const;

    // The member of an object; a value that does not exist where there is none.
    JsonValue operator[](std::string_view key) const;
    // The elements of an array. `optional_items` takes an absent array for an empty one.
    std::vector<JsonValue> items() const;
    std::vector<JsonValue> optional_items() const;
    // The members of an object by their keys, in the keys' order; none where it is absent.
    std::vector<std::pair<std::string, JsonValue>> optional_members() const;
    // Makes every key that is not listed an error.
    void allow_only(std::initializer_list<std::string_view> keys) const;
    void allow_only(std::span<const std::string_view> keys) const;

    double number(const NumberRange& range = {}) const;
    std::int64_t integer(std::int64_t low, std::int64_t high) const;  // written without a fraction
    bool flag() const;
    std::string text() const;  // not empty
    Vec3 vector(const NumberRange& range = {}) const;
    // x, y, z, w within 1e-2 of unit length, made unit.
    Quat rotation() const;

    // The same, with a value for an absent key. A null is not absent.
    double number_or(double fallback, const NumberRange& range = {}) const;
    bool flag_or(bool fallback) const;
    std::string text_or(std::string fallback) const;
    Vec3 vector_or(const Vec3& fallback, const NumberRange& range = {}) const;
    Quat rotation_or(const Quat& fallback) const;
    // A label that may be anything: empty if the value is absent or is not a text.
    std::string label() const;

    // This value as JSON text, for another parser; an object without these members.
    std::string dump_without(std::initializer_list<std::string_view> keys) const;

    const std::string& pointer() const { return pointer_; }
    // Keeps the error "expected <what>, found <this value>" unless there is one already.
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
    // Refused: what is not JSON (the error names line and column), a key twice in one object, a
    // number that no double holds, text that is not UTF-8, more than 64 levels of nesting. `file`
    // is only for messages.
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
