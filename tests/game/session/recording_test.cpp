#include "game/session/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "engine/core/text_file.hpp"
#include "game/session/playback.hpp"
#include "tests/places.hpp"

namespace handhold::recording_test {
namespace {

namespace fs = std::filesystem;

const char* const k_header =
    "t,hx,hy,hz,hqx,hqy,hqz,hqw,lx,ly,lz,lqx,lqy,lqz,lqw,lbtn,ltrig,rx,ry,rz,rqx,rqy,rqz,rqw,rbtn,"
    "rtrig";

using Row = std::vector<std::string>;

Row row_at(const char* t_s) {
    return {t_s, "1", "2", "3",   "0", "0", "0", "1", "4", "5", "6", "0", "0",
            "0", "1", "2", "0.5", "7", "8", "9", "0", "0", "0", "1", "4", "1"};
}

std::string write(const std::vector<Row>& rows) {
    std::string text = k_header;
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            text += i == 0 ? "\n" : ",";
            text += row[i];
        }
    }
    return text + "\n";
}

FileError error_of(const std::string& text) {
    const Result<Recording> recording = parse_recording(text, "f.csv");
    EXPECT_FALSE(recording.ok()) << text;
    return recording.ok() ? FileError() : recording.error();
}

// The text between ```csv and ``` of a document.
std::string example_of(const fs::path& document) {
    const std::string text = read_file(document).value();
    const std::string opening = "```csv\n";
    const std::size_t begin = text.find(opening) + opening.size();
    return text.substr(begin, text.find("```", begin) - begin);
}

bool are_same_bits(const hh::Pose& a, const hh::Pose& b) {
    const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    const hh::Vec3& p = a.position;
    const hh::Quat& q = a.rotation;
    return same(p.x, b.position.x) && same(p.y, b.position.y) && same(p.z, b.position.z) &&
           same(q.x, b.rotation.x) && same(q.y, b.rotation.y) && same(q.z, b.rotation.z) &&
           same(q.w, b.rotation.w);
}

bool is_lost(const hh::Pose& pose) {
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    return are_same_bits(pose, {{k_nan, k_nan, k_nan}, {k_nan, k_nan, k_nan, k_nan}});
}

bool are_same_bits(const RecordedSample& a, const RecordedSample& b) {
    bool result =
        a.t_s == b.t_s && are_same_bits(a.head, b.head) && a.is_head_inferred == b.is_head_inferred;
    for (std::size_t hand = 0; hand < 2; ++hand) {
        result = result && are_same_bits(a.hands[hand].controller, b.hands[hand].controller) &&
                 a.hands[hand].buttons == b.hands[hand].buttons &&
                 a.hands[hand].squeeze == b.hands[hand].squeeze &&
                 a.hands[hand].trigger == b.hands[hand].trigger &&
                 a.hands[hand].is_inferred == b.hands[hand].is_inferred &&
                 std::ranges::equal(a.hands[hand].curls.fingers, b.hands[hand].curls.fingers);
    }
    return result;
}

TEST(Recording, ReadsEveryColumnWhereItBelongs) {
    const Result<Recording> recording =
        parse_recording(write({row_at("0"), row_at("0.011")}), "f.csv");
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    ASSERT_EQ(recording.value().samples.size(), 2U);
    const RecordedSample& sample = recording.value().samples[1];
    EXPECT_EQ(sample.t_s, 0.011);
    EXPECT_TRUE(sample.head.position == (hh::Vec3{1.0, 2.0, 3.0}));
    EXPECT_TRUE(sample.hands[0].controller.position == (hh::Vec3{4.0, 5.0, 6.0}));
    EXPECT_EQ(sample.hands[0].buttons, k_button_trigger);
    EXPECT_EQ(sample.hands[0].squeeze, 0.5);
    EXPECT_EQ(sample.hands[0].trigger, 0.0);  // no column
    EXPECT_TRUE(sample.hands[1].controller.position == (hh::Vec3{7.0, 8.0, 9.0}));
    EXPECT_EQ(sample.hands[1].buttons, k_button_grip);
    EXPECT_NE(sample.hands[0].buttons & k_grab_buttons, 0);
    EXPECT_EQ(k_grab_buttons, 6);  // the file format says so
}

TEST(Recording, OrderOfColumnsAndExtraColumnsMakeNoDifference) {
    // The same two rows with all columns reversed and one more in front.
    std::string text = "extra";
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin < std::string(k_header).size();) {
        const std::string header = k_header;
        const std::size_t end = std::min(header.find(',', begin), header.size());
        names.push_back(header.substr(begin, end - begin));
        begin = end + 1;
    }
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
        text += "," + *name;
    }
    for (const char* t_s : {"0", "0.011"}) {
        text += "\n-99";
        const Row row = row_at(t_s);
        for (auto cell = row.rbegin(); cell != row.rend(); ++cell) {
            text += "," + *cell;
        }
    }
    const Result<Recording> reversed = parse_recording(text, "f.csv");
    const Result<Recording> plain = parse_recording(write({row_at("0"), row_at("0.011")}), "f.csv");
    ASSERT_TRUE(reversed.ok()) << reversed.error().message();
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(are_same_bits(reversed.value().samples[i], plain.value().samples[i]));
    }
}

TEST(Recording, TriggersOutsideTheirRangeAreRefused) {
    const std::string text = write({row_at("0"), row_at("0.011")});
    const auto with_triggers = [&](const std::string& right) {
        std::string lines = text;
        lines.insert(lines.find('\n'), ",lindex,rindex");
        lines.insert(lines.find('\n', lines.find('\n') + 1), ",0.25,1");
        lines.insert(lines.size() - 1, ",0," + right);
        return lines;
    };
    const Result<Recording> good = parse_recording(with_triggers("0.5"), "f.csv");
    ASSERT_TRUE(good.ok()) << good.error().message();
    EXPECT_EQ(good.value().samples[0].hands[0].trigger, 0.25);
    EXPECT_EQ(good.value().samples[1].hands[1].trigger, 0.5);
    for (const char* bad : {"1.5", "-0.1", "nan"}) {
        const FileError error = error_of(with_triggers(bad));
        EXPECT_NE(error.message().find("\"rindex\""), std::string::npos) << error.message();
    }
}

// Optional columns: guesses and curls. Recordings without them say nothing of either.
TEST(Recording, GuessesAndCurlsAreReadAndPlayed) {
    const auto text_of = [](const std::string& columns, const std::string& cells) {
        std::string text = k_header + columns + "\n";
        for (const char* t_s : {"0", "1"}) {
            for (const std::string& cell : row_at(t_s)) {
                text += (text.back() == '\n' ? "" : ",") + cell;
            }
            text += cells + "\n";
        }
        return text;
    };
    const Result<Recording> said =
        parse_recording(text_of(",rinferred,lcurl_index,hinferred", ",1,0.5,1"), "f.csv");
    ASSERT_TRUE(said.ok()) << said.error().message();
    const std::vector<RecordedSample>& samples = said.value().samples;
    EXPECT_TRUE(samples[0].is_head_inferred && samples[0].hands[1].is_inferred);
    EXPECT_FALSE(samples[0].hands[0].is_inferred);
    EXPECT_EQ(samples[0].hands[0].curls.fingers[1], 0.5);
    EXPECT_EQ(samples[0].hands[0].curls.fingers[0], k_curl_unknown);
    EXPECT_EQ(samples[0].hands[1].curls.fingers[4], k_curl_unknown);
    Playback playback(said.value());
    const hh::Sample played = playback.window(0.5).front();
    EXPECT_TRUE(played.head_inferred && played.hand_inferred[1]);
    EXPECT_EQ(played.curls[0].fingers[1], 0.5);
    for (const char* cell : {",2", ",0.5", ",-1"}) {
        EXPECT_NE(error_of(text_of(",linferred", cell)).expected.find("linferred"),
                  std::string::npos);
    }
    for (const char* cell : {",1.5", ",-0.5"}) {
        EXPECT_NE(error_of(text_of(",rcurl_thumb", cell)).expected.find("rcurl_thumb"),
                  std::string::npos);
    }
}

TEST(Recording, OneNanCellLosesItsPoseOnly) {
    Row lost = row_at("0.011");
    lost[12] = "nan";  // lqy
    const Result<Recording> recording = parse_recording(write({row_at("0"), lost}), "f.csv");
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    const RecordedSample& sample = recording.value().samples[1];
    EXPECT_TRUE(is_lost(sample.hands[0].controller));
    EXPECT_EQ(sample.hands[0].buttons, 2);
    EXPECT_TRUE(hh::is_valid(sample.head));
    EXPECT_TRUE(hh::is_valid(sample.hands[1].controller));
}

// Times of clocks that count from any epoch: only differences matter. The steps are multiples of
// 1/512 s, which doubles hold exactly beside 1e12 s.
RC_GTEST_PROP(Recording, PlaysAlikeFromAnyOrigin, ()) {
    const double origin_s = *rc::gen::oneOf(
        rc::gen::map(rc::gen::inRange<std::int64_t>(-999'999'999'999, 999'999'999'999),
                     [](std::int64_t s) { return static_cast<double>(s); }),
        rc::gen::element(1764281138.0, 63892800000.0, 13408000000.0));
    Recording plain;
    std::string text = k_header;
    int ticks = 0;
    for (int i = 0; i < 5; ++i) {
        ticks += *rc::gen::inRange(1, 40);
        for (Row row = row_at("0"); auto& cell : row) {
            const bool is_time = &cell == &row.front();
            std::array<char, 64> time{};
            std::snprintf(time.data(), time.size(), "%.9f", origin_s + ticks / 512.0);  // NOLINT
            text += is_time ? std::string("\n") + time.data() : "," + cell;
        }
        RecordedSample sample;
        sample.t_s = ticks / 512.0;
        plain.samples.push_back(sample);
    }
    const Result<Recording> read = parse_recording(text, "f.csv");
    RC_ASSERT(read.ok());
    Playback moved(read.value());
    Playback expected(plain);
    RC_ASSERT(moved.duration_s() == expected.duration_s());
    const std::span<const hh::Sample> all = moved.window(1.0);
    const std::span<const hh::Sample> wanted = expected.window(1.0);
    RC_ASSERT(all.size() == wanted.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        RC_ASSERT(all[i].time_s == wanted[i].time_s);
    }
}

// Some recorders write a lost device so.
TEST(Recording, QuaternionOfZerosLosesItsPoseOnly) {
    Row lost = row_at("0.011");
    lost[7] = "0";                                             // head
    lost[20] = lost[21] = lost[22] = lost[23] = "-0.0000000";  // right hand
    const Result<Recording> recording = parse_recording(write({row_at("0"), lost}), "f.csv");
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    const RecordedSample& sample = recording.value().samples[1];
    EXPECT_TRUE(is_lost(sample.head));
    EXPECT_TRUE(is_lost(sample.hands[1].controller));
    EXPECT_EQ(sample.hands[1].buttons, k_button_grip);
    EXPECT_TRUE(hh::is_valid(sample.hands[0].controller));
}

TEST(Recording, QuaternionsWithinOnePercentAreMadeUnit) {
    Row nearly = row_at("0");
    nearly[7] = "1.009";
    const Result<Recording> recording = parse_recording(write({nearly, row_at("1")}), "f.csv");
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    EXPECT_EQ(recording.value().samples[0].head.rotation.w, 1.0);
}

struct BadCell {
    const char* what;
    std::size_t cell;
    const char* text;
};

TEST(Recording, BadCellsAreRefusedByLine) {
    const BadCell k_bad[] = {
        {"equal time", 0, "0"},          {"earlier time", 0, "-1"},
        {"time nan", 0, "nan"},          {"time too large", 0, "1e13"},
        {"head too far", 1, "2e6"},      {"head infinite", 1, "inf"},
        {"head no number", 2, "up"},     {"quaternion long", 7, "1.011"},
        {"quaternion short", 7, "0.98"}, {"quaternion huge", 7, "1e200"},
        {"button nan", 15, "nan"},       {"button negative", 15, "-1"},
        {"button fraction", 15, "1.5"},  {"button too large", 24, "65536"},
        {"trigger above 1", 16, "1.01"}, {"trigger below 0", 25, "-0.1"},
        {"trigger nan", 16, "nan"},
    };
    for (const BadCell& bad : k_bad) {
        Row row = row_at("1");
        row[bad.cell] = bad.text;
        const FileError error = error_of(write({row_at("0"), row}));
        EXPECT_EQ(error.file, "f.csv") << bad.what;
        EXPECT_EQ(error.place, "line 3") << bad.what;
        EXPECT_EQ(error.expected.rfind("expected ", 0), 0U) << bad.what;
    }
}

TEST(Recording, MissingColumnIsNamed) {
    std::string text = write({row_at("0"), row_at("1")});
    text.replace(text.find("rbtn"), 4, "rbut");
    EXPECT_EQ(error_of(text).message(), R"(f.csv: line 1: expected a column "rbtn", found none)");
}

TEST(Recording, NeedsTwoSamples) {
    EXPECT_EQ(error_of(write({})).message(), "f.csv: expected at least 2 samples, found 0");
    EXPECT_EQ(error_of(write({row_at("0")})).message(),
              "f.csv: expected at least 2 samples, found 1");
}

// A truncated file either breaks a row, or has fewer samples or fewer digits in its last cell.
TEST(Recording, EveryTruncationIsAnErrorOrAShorterRecording) {
    const std::string whole = write({row_at("0"), row_at("1"), row_at("2")});
    for (std::size_t length = 0; length + 2 < whole.size(); ++length) {
        const Result<Recording> recording = parse_recording(whole.substr(0, length), "f.csv");
        if (recording.ok()) {
            EXPECT_EQ(recording.value().samples.size(), 2U) << length;
        } else {
            EXPECT_EQ(recording.error().file, "f.csv");
        }
    }
}

TEST(Recording, SavedOneLoadsAsTheSameBits) {
    const fs::path path = fs::temp_directory_path() / "handhold_recording_test.csv";
    rc::check([&] {
        const auto number = [](double low, double high) {
            return low + (high - low) * (*rc::gen::inRange(0, 1000001)) / 1e6 / std::sqrt(1.000003);
        };
        const bool says_more = *rc::gen::arbitrary<bool>();
        Recording recording;
        for (int i = 0; i < 3; ++i) {
            RecordedSample sample;
            sample.t_s = i + number(0.0, 0.9);
            for (hh::Pose* pose :
                 {&sample.head, &sample.hands[0].controller, &sample.hands[1].controller}) {
                pose->position = {number(-3, 3), number(0, 2), number(-1e5, 1e5)};
                pose->rotation = hh::normalized(
                    hh::Quat{number(-1, 1), number(-1, 1), number(-1, 1), number(0.1, 1)});
            }
            sample.hands[0].squeeze = number(0.0, 1.0);
            sample.hands[0].trigger = number(0.0, 1.0);
            sample.hands[1].trigger = number(0.0, 1.0);
            sample.hands[1].buttons = *rc::gen::inRange(0, 16);
            if (says_more) {
                sample.is_head_inferred = *rc::gen::arbitrary<bool>();
                sample.hands[0].is_inferred = *rc::gen::arbitrary<bool>();
                sample.hands[1].is_inferred = *rc::gen::arbitrary<bool>();
                sample.hands[1].curls = {{number(0.0, 1.0), 0.0, 1.0, k_curl_unknown, 0.25}};
            }
            recording.samples.push_back(sample);
        }
        const double nan = std::nan("");
        recording.samples[1].head = {{nan, nan, nan}, {nan, nan, nan, nan}};
        RC_ASSERT(!save_recording(path, recording));
        const Result<Recording> loaded = load_recording(path);
        RC_ASSERT(loaded.ok());
        RC_ASSERT(loaded.value().samples.size() == recording.samples.size());
        for (std::size_t i = 0; i < recording.samples.size(); ++i) {
            RC_ASSERT(are_same_bits(loaded.value().samples[i], recording.samples[i]));
        }
    });
    fs::remove(path);
}

TEST(Recording, SaveIntoAbsentFolderIsAnError) {
    EXPECT_TRUE(save_recording("/no/such/folder/a.csv", Recording()).has_value());
}

TEST(Recording, ExampleOfItsDocumentLoads) {
    const std::string example = example_of(source_dir() / "docs/reference/recording_format.md");
    const Result<Recording> recording = parse_recording(example, "recording_format.md");
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    ASSERT_EQ(recording.value().samples.size(), 3U);
    EXPECT_NE(recording.value().samples[1].hands[0].buttons & k_grab_buttons, 0);
    EXPECT_FALSE(hh::is_valid(recording.value().samples[1].hands[1].controller));
}

// MANIFEST and SOURCE.md of vr_input/: 20 recordings, 312 s in all, near 89 Hz, heads 0.5 to 1.8 m
// high.
TEST(RealRecordings, AllTwentyLoad) {
    const fs::path folder = data_dir() / "vr_input";
    if (!fs::exists(folder)) {
        GTEST_SKIP() << "no " << folder;
    }
    int count = 0;
    double seconds = 0.0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") {
            continue;
        }
        const Result<Recording> recording = load_recording(entry.path());
        ASSERT_TRUE(recording.ok()) << recording.error().message();
        const std::vector<RecordedSample>& samples = recording.value().samples;
        seconds += samples.back().t_s - samples.front().t_s;
        for (const RecordedSample& sample : samples) {
            ASSERT_GT(sample.head.position.y, 0.5) << entry.path();
            ASSERT_LT(sample.head.position.y, 1.85) << entry.path();
            ASSERT_TRUE(hh::is_valid(sample.hands[0].controller)) << entry.path();
        }
        ++count;
    }
    EXPECT_EQ(count, 20);
    EXPECT_NEAR(seconds, 312.0, 1.0);
}

}  // namespace
}  // namespace handhold::recording_test
