#include "engine/io/csv.hpp"

#include <cmath>
#include <string>

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
    EXPECT_EQ(error_of("a,b\n1,2\n\n3,4\n").place, "line 3");
}

TEST(Csv, RefusesCellsThatAreNoPlainFiniteNumber) {
    for (const char* cell : {"", " 1", "1 ", "+1", "1.5.2", "0x10", "inf", "-inf", "nan", "1e999",
                             "1,5e", "\"1\"", "1;2", "--1", "1e", "."}) {
        EXPECT_EQ(error_of(std::string("a\n") + cell + "\n1\n").place, "line 2") << cell;
    }
}

TEST(Csv, AllowsNanByTheNameOfNanOnly) {
    const Result<NumericTable> table = parse_csv("a,b\nnan,NaN\n", "f.csv", NanCells::allowed);
    ASSERT_TRUE(table.ok());
    EXPECT_TRUE(std::isnan(table.value().at(0, 0)));
    EXPECT_TRUE(std::isnan(table.value().at(0, 1)));
    for (const char* cell : {"-nan", "nan(1)", "inf", "na", "nano"}) {
        error_of(std::string("a\n") + cell + "\n", NanCells::allowed);
    }
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
