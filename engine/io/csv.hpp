#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/result.hpp"

namespace handhold {

// Numbers under named columns.
struct NumericTable {
    std::vector<std::string> columns;  // not empty, unique
    std::vector<double> cells;         // row by row, columns.size() each

    std::size_t row_count() const { return columns.empty() ? 0 : cells.size() / columns.size(); }
    double at(std::size_t row, std::size_t column) const {
        return cells[row * columns.size() + column];
    }
    std::optional<std::size_t> find_column(std::string_view name) const;
};

enum class NanCells { refused, allowed };

// Reads a strict table: one header row with unique, non-empty names; then rows of as many cells,
// each a decimal number in C notation without spaces, quotes or a leading plus; comma between
// cells; lines end in LF or CRLF, the last one may lack it. Every number is finite; with
// NanCells::allowed a cell may also be the text "nan". A byte order mark is skipped. Locale-free,
// one pass, one allocation for the cells. Row r of the table is line r + 2.
Result<NumericTable> parse_csv(std::string_view text, const std::string& file,
                               NanCells nan = NanCells::refused);
Result<NumericTable> load_csv(const std::filesystem::path& path, NanCells nan = NanCells::refused);

}  // namespace handhold
