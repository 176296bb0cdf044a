#include "engine/io/csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace handhold::io_csv_test {
namespace {

FileError error_of(const std::string& text, NanCells nan = NanCells::refused) {
    const Result<NumericTable> table = parse_csv(text, "f.csv", nan);
    EXPECT_FALSE(table.ok()) << text;
    return table.ok() ? FileError() : table.error();
}

TEST(Csv, ReadsNumbersUnderTheirNames) {
    const Result<NumericTable> table = parse_csv("t,x\n0,-1.5\n0.5,2e3\n", "f.csv");
    ASSERT_TRUE(table.ok()) << table.error().message();
    EXPECT_EQ(table.value().row_count(), 2U);
    EXPECT_EQ(table.value().find_column("x"), 1U);
    EXPECT_FALSE(table.value().find_column("y"));
    EXPECT_EQ(table.value().at(1, 1), 2000.0);
    EXPECT_EQ(table.value().at(0, 1), -1.5);
}

TEST(Csv, LineEndsMakeNoDifference) {
    for (const char* text :
         {"a,b\n1,2\n3,4\n", "a,b\n1,2\n3,4", "a,b\r\n1,2\r\n3,4\r\n", "a,b\r\n1,2\r\n3,4",
          "\xEF\xBB\xBF"
          "a,b\n1,2\n3,4\n"}) {
        const Result<NumericTable> table = parse_csv(text, "f.csv");
        ASSERT_TRUE(table.ok()) << table.error().message();
        EXPECT_EQ(table.value().columns, (std::vector<std::string>{"a", "b"}));
        EXPECT_EQ(table.value().cells, (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
    }
}

TEST(Csv, HeaderAloneIsATableWithoutRows) {
    const Result<NumericTable> table = parse_csv("a,b\n", "f.csv");
    ASSERT_TRUE(table.ok());
    EXPECT_EQ(table.value().row_count(), 0U);
}

TEST(Csv, ErrorsNameLineExpectedAndFound) {
    EXPECT_EQ(error_of("a,b\n1,2\n3\n").message(), "f.csv: line 3: expected 2 cells, found 1");
    EXPECT_EQ(error_of("a,b\n1,2,3\n").message(), "f.csv: line 2: expected 2 cells, found 3");
    EXPECT_EQ(error_of("a,b\n1,x\n").message(),
              R"(f.csv: line 2: expected a finite number under "b", found "x")");
    EXPECT_EQ(error_of("a,a\n").message(),
              R"(f.csv: line 1: expected every column once, found "a" twice)");
    EXPECT_EQ(error_of("").place, "line 1");
    EXPECT_EQ(error_of("\n").place, "line 1");
    EXPECT_EQ(error_of("a,,b\n").place, "line 1");
    EXPECT_EQ(error_of("a,b\n1,\n").place, "line 2");
    EXPECT_EQ(error_of("a,b\n1,2\n\n3,x\n").place, "line 4");
    EXPECT_EQ(error_of("\n\na,a\n").place, "line 3");
}

TEST(Csv, RefusesCellsThatAreNoPlainFiniteNumber) {
    for (const char* cell : {" 1", "1 ", "+1", "1.5.2", "0x10", "inf", "-inf", "nan", "1e999",
                             "1,5e", "\"1\"", "1;2", "--1", "1e", "."}) {
        EXPECT_EQ(error_of(std::string("a\n") + cell + "\n1\n").place, "line 2") << cell;
    }
}

TEST(Csv, OtherThanNanIsRefusedWhereNanIsAllowed) {
    for (const char* cell :
         {"inf", "-inf", "na", "nano", "nan(", "nan)", "nan(1", "nan(1))", "nan()x", "--nan", "n",
          "1.#INF", "1.#QNAN5", "1.#", "nan nan", "nan(-1)"}) {
        error_of(std::string("a\n") + cell + "\n", NanCells::allowed);
    }
}

// The spellings of C libraries: C11 7.21.6.1 ("nan" or "nan(n-char-sequence)" after an optional
// sign, in capitals for %F), Microsoft's since 2015 ("-nan(ind)", "nan(snan)") and before
// ("-1.#IND00", "1.#QNAN"; the precision pads with zeros); "NaN" of Java, JavaScript and C#.
RC_GTEST_PROP(Csv, NanIsReadInEverySpelling, ()) {
    std::string text =
        *rc::gen::element<std::string>("nan", "nan()", "nan(ind)", "nan(snan)",
                                       "nan(0x8000000000000)", "1.#qnan", "1.#ind", "1.#snan");
    if (text.front() == '1') {
        text += std::string(*rc::gen::inRange<std::size_t>(0, 5), '0');
    }
    for (char& letter : text) {
        if (letter >= 'a' && letter <= 'z' && *rc::gen::arbitrary<bool>()) {
            letter = static_cast<char>(letter - 'a' + 'A');
        }
    }
    text = *rc::gen::element<std::string>("", "-", "+") + text;
    const Result<NumericTable> table =
        parse_csv("a,b\n" + text + ",1\n", "f.csv", NanCells::allowed);
    RC_ASSERT(table.ok());
    RC_ASSERT(std::isnan(table.value().at(0, 0)));
    RC_ASSERT(table.value().at(0, 1) == 1.0);
    RC_ASSERT(!parse_csv("a,b\n" + text + ",1\n", "f.csv", NanCells::refused).ok());
}

// What this machine's own printf makes of NaNs of either sign and any payload.
TEST(Csv, ReadsWhatPrintfMakesOfNan) {
    for (const char* format : {"%f", "%g", "%e", "%.17g", "%F", "%+f", "%a"}) {
        for (const double nan : {std::nan(""), -std::nan(""), std::nan("1234")}) {
            std::array<char, 64> text{};
            std::snprintf(text.data(), text.size(), format, nan);  // NOLINT(*-vararg)
            const Result<NumericTable> table =
                parse_csv(std::string("a\n") + text.data() + "\n", "f.csv", NanCells::allowed);
            ASSERT_TRUE(table.ok()) << text.data();
            EXPECT_TRUE(std::isnan(table.value().cells.at(0))) << text.data();
        }
    }
}

RC_GTEST_PROP(Csv, BlankLinesChangeNothingButLineNumbers, ()) {
    const auto blanks = [] {
        std::string text;
        for (int count = *rc::gen::inRange(0, 4); count > 0; --count) {
            text += *rc::gen::element<std::string>("", " ", "\t", "  \t ") +
                    *rc::gen::element<std::string>("\n", "\r\n");
        }
        return text;
    };
    std::string text = blanks() + "a,b\n";
    const int rows = *rc::gen::inRange(0, 5);
    std::vector<double> cells;
    std::vector<std::size_t> lines;
    for (int row = 0; row < rows; ++row) {
        text += blanks();
        lines.push_back(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
        text += std::to_string(row) + ",-1\n";
        cells.insert(cells.end(), {static_cast<double>(row), -1.0});
    }
    text += blanks();
    const Result<NumericTable> table = parse_csv(text, "f.csv");
    RC_ASSERT(table.ok());
    RC_ASSERT(table.value().cells == cells);
    RC_ASSERT(table.value().lines == lines);
    const FileError error = error_of(text + "1\n");
    RC_ASSERT(error.place ==
              "line " + std::to_string(std::count(text.begin(), text.end(), '\n') + 1));
}

TEST(Csv, LongCellsAreCutInMessages) {
    EXPECT_LT(error_of("a\n" + std::string(1000000, 'x') + "\n").message().size(), 200U);
}

TEST(Csv, EveryTruncationIsAnErrorOrFewerCells) {
    const std::string whole = "a,b\n1.25,-2e2\r\n3,4\n";
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const Result<NumericTable> table = parse_csv(whole.substr(0, length), "f.csv");
        if (table.ok()) {
            EXPECT_EQ(table.value().cells.size(),
                      table.value().row_count() * table.value().columns.size());
        } else {
            EXPECT_EQ(table.error().place.rfind("line ", 0), 0U);
        }
    }
}

RC_GTEST_PROP(Csv, AnyBytesGiveATableOrAnErrorWithItsLine, (std::string bytes)) {
    const Result<NumericTable> table = parse_csv(bytes, "f.csv");
    if (table.ok()) {
        RC_ASSERT(table.value().cells.size() % table.value().columns.size() == 0U);
    } else {
        RC_ASSERT(table.error().place.rfind("line ", 0) == 0U);
    }
}

}  // namespace
}  // namespace handhold::io_csv_test
