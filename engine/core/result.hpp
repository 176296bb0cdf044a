#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "engine/core/check.hpp"
#include "engine/core/printable.hpp"

namespace handhold {

// Why a file was refused. No part of a refused file is loaded.
struct FileError {
    std::string file;
    std::string place;     // "line 12", a JSON pointer such as "/bodies/3/mass_kg", or empty if the
                           // error concerns the whole file
    std::string expected;  // what the reader expected, and what it found

    // One line: "ship.json: /bodies/3/mass_kg: expected a number above 0, found -2". Control
    // characters are escaped and long texts cut (printable.hpp), because any field may quote a
    // file.
    std::string message() const;
};

// A value, or the reason why there is none.
template <typename T>
class Result {
  public:
    Result(T value) : content_(std::move(value)) {}          // NOLINT(google-explicit-constructor)
    Result(FileError error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    bool ok() const { return std::holds_alternative<T>(content_); }
    explicit operator bool() const { return ok(); }
    // Precondition: ok().
    T& value() {
        HH_CHECK(ok(), "no value", 0);
        return *std::get_if<T>(&content_);
    }
    const T& value() const {
        HH_CHECK(ok(), "no value", 0);
        return *std::get_if<T>(&content_);
    }
    // Precondition: !ok().
    const FileError& error() const {
        HH_CHECK(!ok(), "no error", 0);
        return *std::get_if<FileError>(&content_);
    }

  private:
    std::variant<T, FileError> content_;
};

}  // namespace handhold
