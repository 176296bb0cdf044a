#include "engine/io/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/core/text_file.hpp"

namespace handhold {

namespace {

// Quotes a cell for an error message. Shortens it, because a cell may be a megabyte long.
std::string quote(std::string_view cell) {
    constexpr std::size_t k_shown_characters = 40;
    return '"' + printable(cell, k_shown_characters) + '"';
}

// Removes the next line from `rest` and returns it without its line end.
std::string_view take_line(std::string_view& rest) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (!line.empty() && line.back() == '\r') {
        line.remove_suffix(1);
    }
    return line;
}

std::size_t count_cells(std::string_view line) {
    return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

bool is_blank(std::string_view line) {
    return line.find_first_not_of(" \t\r\f\v") == std::string_view::npos;
}

// Removes `prefix`, of lower-case letters, from the front of `text`, whatever case it has there.
bool skip_letters(std::string_view& text, std::string_view prefix) {
    const auto same = [](char letter, char lower) {
        return (letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter) ==
               lower;
    };
    if (text.size() < prefix.size() ||
        !std::equal(prefix.begin(), prefix.end(), text.begin(),
                    [&](char lower, char letter) { return same(letter, lower); })) {
        return false;
    }
    text.remove_prefix(prefix.size());
    return true;
}

// True if the cell is a NaN as printf, iostreams or other languages write it: "nan", "-nan",
// "+NaN", "nan(ind)", "-nan(0x8000000000000)", and "1.#QNAN" or "-1.#IND000" by C libraries of
// Windows before 2015.
bool is_nan_text(std::string_view cell) {
    if (!cell.empty() && (cell.front() == '-' || cell.front() == '+')) {
        cell.remove_prefix(1);
    }
    if (skip_letters(cell, "1.#")) {
        return (skip_letters(cell, "qnan") || skip_letters(cell, "snan") ||
                skip_letters(cell, "ind")) &&
               cell.find_first_not_of('0') == std::string_view::npos;
    }
    if (!skip_letters(cell, "nan")) {
        return false;
    }
    constexpr std::string_view k_payload =
        "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    return cell.empty() ||
           (cell.size() >= 2 && cell.front() == '(' &&
            cell.find_first_not_of(k_payload, 1) == cell.size() - 1 && cell.back() == ')');
}

bool parse_cell(std::string_view cell, NanCells nan, double& value) {
    const char* end = cell.data() + cell.size();
    const std::from_chars_result result = std::from_chars(cell.data(), end, value);
    if (result.ec == std::errc() && result.ptr == end && std::isfinite(value)) {
        return true;
    }
    value = std::numeric_limits<double>::quiet_NaN();
    return nan == NanCells::allowed && is_nan_text(cell);
}

std::optional<FileError> parse_header(std::string_view line, std::size_t line_number,
                                      const std::string& file, std::vector<std::string>& columns) {
    const std::string place = "line " + std::to_string(line_number);
    columns.reserve(count_cells(line));
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        const std::string_view name = line.substr(begin, end - begin);
        if (name.empty() || name.find_first_of("\"\r\t ") != std::string_view::npos) {
            return FileError{
                file, place,
                "expected a column name without quotes and spaces, found " + quote(name)};
        }
        columns.emplace_back(name);
        begin = end + 1;
    }
    std::vector<std::string> sorted = columns;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) {
        return FileError{file, place,
                         "expected every column once, found " + quote(*twice) + " twice"};
    }
    return std::nullopt;
}

// Appends the cells of one line.
std::optional<FileError> parse_row(std::string_view line, std::size_t line_number, NanCells nan,
                                   const std::string& file, NumericTable& table) {
    const auto refuse = [&](std::string expected) {
        return FileError{file, "line " + std::to_string(line_number), std::move(expected)};
    };
    std::size_t column = 0;
    for (std::size_t begin = 0; begin <= line.size(); ++column) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        const std::string_view cell = line.substr(begin, end - begin);
        begin = end + 1;
        if (column >= table.columns.size()) {
            continue;  // skipped here: the error below states the number of cells
        }
        double value = 0.0;
        if (!parse_cell(cell, nan, value)) {
            return refuse("expected a finite number under \"" + table.columns[column] + "\"" +
                          (nan == NanCells::allowed ? " or nan" : "") + ", found " + quote(cell));
        }
        table.cells.push_back(value);
    }
    if (column != table.columns.size()) {
        return refuse("expected " + std::to_string(table.columns.size()) + " cells, found " +
                      std::to_string(column));
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::size_t> NumericTable::find_column(std::string_view name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found == columns.end()) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(found - columns.begin());
}

Result<NumericTable> parse_csv(std::string_view text, const std::string& file, NanCells nan) {
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
    if (text.substr(0, k_byte_order_mark.size()) == k_byte_order_mark) {
        text.remove_prefix(k_byte_order_mark.size());
    }
    NumericTable table;
    std::size_t line_number = 0;
    while (table.columns.empty()) {
        if (text.empty()) {
            return FileError{file, "line 1", "expected a row of column names, found an empty file"};
        }
        const std::string_view line = take_line(text);
        ++line_number;
        if (is_blank(line)) {
            continue;
        }
        if (std::optional<FileError> error = parse_header(line, line_number, file, table.columns)) {
            return *std::move(error);
        }
    }
    table.header_line = line_number;
    // A cell takes at least two bytes: one character, and a comma or line end.
    const std::size_t lines =
        static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    table.cells.reserve(std::min(lines * table.columns.size(), text.size() / 2 + 1));
    table.lines.reserve(std::min(lines, text.size() / 2 + 1));
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        ++line_number;
        if (is_blank(line)) {
            continue;
        }
        table.lines.push_back(line_number);
        if (std::optional<FileError> error = parse_row(line, line_number, nan, file, table)) {
            return *std::move(error);
        }
    }
    return table;
}

Result<NumericTable> load_csv(const std::filesystem::path& path, NanCells nan) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    return parse_csv(text.value(), path.string(), nan);
}

}  // namespace handhold
