#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"
#include "game/report/frames_csv.hpp"
#include "game/report/text.hpp"
#include "tests/game/report/report_log.hpp"

namespace handhold::report_csv_test {
namespace {

using Row = std::vector<std::string>;

// RFC 4180, with LF.
std::vector<Row> read_csv(const std::string& text) {
    std::vector<Row> rows;
    Row row(1);
    bool is_quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (is_quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
            row.back() += '"';
            ++i;
        } else if (c == '"') {
            is_quoted = !is_quoted;
        } else if (c == ',' && !is_quoted) {
            row.emplace_back();
        } else if (c == '\n' && !is_quoted) {
            rows.push_back(row);
            row.assign(1, "");
        } else {
            row.back() += c;
        }
    }
    return rows;
}

double to_number(const std::string& text) {
    double value = 0.0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    EXPECT_EQ(end.ptr, text.data() + text.size()) << text;
    return value;
}

// The cell of a row in the named column.
std::string cell(const std::vector<Row>& rows, std::size_t row, const std::string& column) {
    for (std::size_t i = 0; i < rows[0].size(); ++i) {
        if (rows[0][i] == column) {
            return rows[row][i];
        }
    }
    ADD_FAILURE() << "no column " << column;
    return {};
}

Row contract_columns() {
    Row columns = {"frame",    "t",      "player", "origin_x", "origin_y",
                   "origin_z", "head_x", "head_y", "head_z"};
    for (const std::string hand : {"l_", "r_"}) {
        for (const char* const name : {"target_x", "target_y", "target_z", "shown_x", "shown_y",
                                       "shown_z", "grip", "body", "grab_error_mm"}) {
            columns.push_back(hand + name);
        }
    }
    columns.insert(columns.end(), {"push_back_mm", "residual_mm", "contacts"});
    return columns;
}

TEST(FramesCsv, BeginsWithTheColumnsOfTheContract) {
    const std::vector<Row> rows = read_csv(format_frames_csv(RunLog()));
    ASSERT_EQ(rows.size(), 1U);
    const Row expected = contract_columns();
    ASSERT_GE(rows[0].size(), expected.size());
    EXPECT_EQ(Row(rows[0].begin(), rows[0].begin() + static_cast<std::ptrdiff_t>(expected.size())),
              expected);
}

TEST(FramesCsv, HasARowOfAllColumnsForEachFrameAndPlayer) {
    const std::vector<Row> rows = read_csv(format_frames_csv(make_gripping_run()));
    ASSERT_EQ(rows.size(), 1U + 4U * 2U);
    for (const Row& row : rows) {
        EXPECT_EQ(row.size(), rows[0].size());
    }
    EXPECT_EQ(cell(rows, 3, "frame"), "2");
    EXPECT_EQ(cell(rows, 3, "t"), "1");
    EXPECT_EQ(cell(rows, 3, "player"), "0");
    EXPECT_EQ(cell(rows, 4, "player"), "1");
    EXPECT_EQ(cell(rows, 3, "origin_y"), "4");
    EXPECT_EQ(cell(rows, 3, "head_y"), "5.5");
}

TEST(FramesCsv, NamesBodiesAndWritesErrorsInMillimetres) {
    const std::vector<Row> rows = read_csv(format_frames_csv(make_gripping_run()));
    EXPECT_EQ(cell(rows, 1, "l_body"), "rail");
    EXPECT_EQ(cell(rows, 1, "l_grip"), "1");
    EXPECT_EQ(cell(rows, 1, "l_grab_error_mm"), "0.9765625");  // 1000 / 1024
    EXPECT_EQ(cell(rows, 1, "r_body"), "");
    EXPECT_EQ(cell(rows, 1, "r_grip"), "0");
    EXPECT_EQ(cell(rows, 3, "r_body"), "rock, \"small\"");
    EXPECT_EQ(cell(rows, 3, "contacts"), "2");
    EXPECT_EQ(cell(rows, 7, "push_back_mm"), "125");
}

TEST(FramesCsv, EveryVectorComesBackBitForBit) {
    RunLog log = make_small_run();
    log.frames.resize(1);
    log.frames[0].players.resize(1);
    PlayerLog& player = log.frames[0].players[0];
    HandLog& left = player.hands[HH_LEFT];
    HandLog& right = player.hands[HH_RIGHT];
    const std::array<std::pair<const char*, hh::Vec3*>, 7> vectors = {
        {{"origin_", &player.origin_ws},
         {"head_", &player.head_ws},
         {"velocity_", &player.velocity_mps},
         {"l_target_", &left.target_ws},
         {"l_shown_", &left.shown_ws},
         {"r_target_", &right.target_ws},
         {"r_shown_", &right.shown_ws}}};
    double value = 1.0 / 3.0;
    for (const auto& [name, vector] : vectors) {
        for (double* const part : {&vector->x, &vector->y, &vector->z}) {
            *part = value;
            value *= -1.0 / 7.0;
        }
    }
    const std::vector<Row> rows = read_csv(format_frames_csv(log));
    for (const auto& [name, vector] : vectors) {
        EXPECT_EQ(to_number(cell(rows, 1, std::string(name) + "x")), vector->x) << name;
        EXPECT_EQ(to_number(cell(rows, 1, std::string(name) + "y")), vector->y) << name;
        EXPECT_EQ(to_number(cell(rows, 1, std::string(name) + "z")), vector->z) << name;
    }
}

TEST(FramesCsv, DoesNotDependOnHowLongStagesTook) {
    RunLog slow = make_small_run();
    slow.wall_s = 100.0;
    slow.frames[2].stats.stage_us[0] = 1e6;
    EXPECT_EQ(format_frames_csv(slow), format_frames_csv(make_small_run()));
    EXPECT_EQ(format_bodies_csv(slow), format_bodies_csv(make_small_run()));
}

TEST(FramesCsv, RefusesIndicesWithoutAName) {
    RunLog log = make_small_run();
    log.frames[3].players[1].player = 2;
    EXPECT_THROW(format_frames_csv(log), PreconditionError);
    log = make_small_run();
    grip(log.frames[0], HH_LEFT, 3, 0.0);
    EXPECT_THROW(format_frames_csv(log), PreconditionError);
    log = make_small_run();
    log.frames[0].bodies[0].body = 3;
    EXPECT_THROW(format_bodies_csv(log), PreconditionError);
}

TEST(FramesCsv, FailedWriteNamesTheFile) {
    const std::filesystem::path path = "/nowhere/frames.csv";
    const std::optional<FileError> error = write_frames_csv(path, make_small_run());
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->file, path.string());
}

TEST(FramesCsv, FileHoldsTheFormattedText) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "handhold_report_frames.csv";
    ASSERT_FALSE(write_frames_csv(path, make_small_run()));
    const Result<std::string> text = read_file(path);
    ASSERT_TRUE(text.ok());
    EXPECT_EQ(text.value(), format_frames_csv(make_small_run()));
    std::filesystem::remove(path);
}

TEST(BodiesCsv, HasTheColumnsOfTheContractAndARowForEachFrameAndBody) {
    RunLog log = make_small_run();
    BodyLog& rock = log.frames[0].bodies[0];
    rock.pose_ws.rotation = {-0.5, 0.5, -0.5, 0.5};
    rock.velocity_mps = {1.0, 2.0, 3.0};
    rock.spin_radps = {4.0, 5.0, 6.0};
    const std::vector<Row> rows = read_csv(format_bodies_csv(log));
    ASSERT_EQ(rows.size(), 1U + 4U * 2U);
    EXPECT_EQ(rows[0], (Row{"frame", "t", "body", "mass_kg", "x", "y", "z", "qx", "qy", "qz", "qw",
                            "vx", "vy", "vz", "wx", "wy", "wz"}));
    EXPECT_EQ(rows[1], (Row{"1", "0.5", "rock, \"small\"", "5", "0.5", "0.25", "0", "-0.5", "0.5",
                            "-0.5", "0.5", "1", "2", "3", "4", "5", "6"}));
    EXPECT_EQ(rows[2][2], "cart");
}

RC_GTEST_PROP(ReportText, NumberComesBackBitForBit, ()) {
    const auto value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
    RC_PRE(!std::isnan(value));
    std::string text;
    append_number(text, value);
    RC_ASSERT(std::bit_cast<std::uint64_t>(to_number(text)) == std::bit_cast<std::uint64_t>(value));
}

RC_GTEST_PROP(ReportText, QuotedCellComesBack, (const std::string& cell)) {
    RC_ASSERT(read_csv(quote_csv(cell) + "\n") == std::vector<Row>{Row{cell}});
}

TEST(ReportText, NanHasOneSpelling) {
    for (const double nan :
         {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::quiet_NaN()}) {
        std::string text;
        append_number(text, nan);
        EXPECT_EQ(text, "nan");
    }
}

TEST(ReportText, FiguresAreShortAndGrouped) {
    EXPECT_EQ(format_figure(0.0), "0");
    EXPECT_EQ(format_figure(60.0), "60");
    EXPECT_EQ(format_figure(3.14159265), "3.142");
    EXPECT_EQ(format_figure(-0.0416), "−0.0416");
    EXPECT_EQ(format_figure(9999.0), "9999");
    EXPECT_EQ(format_figure(1234567.0), "1\u2009234\u2009567");
    EXPECT_EQ(format_figure(1.25e-7), "1.25×10⁻⁷");
    EXPECT_EQ(format_figure(9.9999e-8), "1.00×10⁻⁷");
    EXPECT_EQ(format_figure(-2e12), "−2.00×10¹²");
    EXPECT_EQ(format_figure(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace handhold::report_csv_test
