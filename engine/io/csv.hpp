#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace handhold {

// A table of numbers with named columns.
struct NumericTable {
    std::vector<std::string> columns;  // names are unique and not empty
    std::vector<double> cells;         // line by line; columns.size() per line
    std::vector<std::size_t> lines;    // number of each line in the file, from 1
    std::size_t header_line = 1;       // the line of the names

    std::size_t row_count() const { return lines.size(); }
    double at(std::size_t row, std::size_t column) const {
        return cells[row * columns.size() + column];
    }
    std::optional<std::size_t> find_column(std::string_view name) const;
};

enum class NanCells { refused, allowed };

// Reads a strict CSV table. The first line holds unique, non-empty names. Every other line has as
// many cells, each a finite decimal number in C notation without spaces, quotes or a leading plus.
// With NanCells::allowed a cell may also be NaN in any spelling of printf ("nan", "-nan",
// "-nan(ind)", "1.#QNAN"). Lines without text are skipped. Cells are separated by commas. Lines end
// in LF or CRLF; the last line may have no end. A byte order mark is skipped. The result does not
// depend on the locale. Takes one pass and one allocation for the cells.
Result<NumericTable> parse_csv(std::string_view text, const std::string& file,
                               NanCells nan = NanCells::refused);
Result<NumericTable> load_csv(const std::filesystem::path& path, NanCells nan = NanCells::refused);

}  // namespace handhold
