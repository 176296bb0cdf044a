#include <cmath>

#include "engine/io/csv.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {
namespace {

void check_table(const Result<NumericTable>& table, NanCells nan) {
    if (!table) {
        promise(!table.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    const NumericTable& cells = table.value();
    promise(cells.columns.empty() || cells.cells.size() % cells.columns.size() == 0,
            "every line has a cell for each column");
    for (const double cell : cells.cells) {
        promise(std::isfinite(cell) || (nan == NanCells::allowed && std::isnan(cell)),
                "cells are finite");
    }
}

}  // namespace

void run_csv(Bytes bytes) {
    for (const NanCells nan : {NanCells::refused, NanCells::allowed}) {
        check_table(parse_csv(text_of(bytes), "fuzz.csv", nan), nan);
    }
}

}  // namespace handhold::fuzz
