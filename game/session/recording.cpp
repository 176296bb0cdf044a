#include "game/session/recording.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <handhold/math.hpp>

namespace handhold {

namespace {

// Any epoch: clocks that count from the year 1 are at 6e10 s. The rounding of a double is still
// 0.1 ms here.
constexpr double k_max_time_s = 1e12;
constexpr double k_max_recorded_m = 1e6;
constexpr double k_max_buttons = 65535.0;
constexpr double k_length_tolerance = 1e-2;
// A quaternion this near to unit length is not normalised. That could change its last bits, but a
// saved recording must load unchanged.
constexpr double k_unit_tolerance = 1e-14;

constexpr std::size_t k_pose_cells = 7;
constexpr std::size_t k_hand_cells = k_pose_cells + 2;
constexpr std::size_t k_head_begin = 1;
constexpr std::array<std::size_t, 2> k_hand_begin = {8, 17};

// The columns in the order in which they are written: t, head, left hand, right hand.
constexpr std::array<const char*, k_head_begin + k_pose_cells + 2 * k_hand_cells> k_columns = {
    "t",  "hx", "hy",  "hz",  "hqx", "hqy", "hqz",  "hqw",   "lx",
    "ly", "lz", "lqx", "lqy", "lqz", "lqw", "lbtn", "ltrig", "rx",
    "ry", "rz", "rqx", "rqy", "rqz", "rqw", "rbtn", "rtrig"};
// Columns that recordings may lack, after the others: triggers by hh::Side, whether head and hands
// are inferred, curls of the left and the right hand thumb first.
constexpr std::size_t k_fingers = std::size(hh_finger_curls{}.fingers);
struct OptionalColumn {
    const char* name;
    double missing;  // the cells' value without the column
};
constexpr std::array<OptionalColumn, 2 + 3 + 2 * k_fingers> k_optional_columns = {
    {{"lindex", 0.0},
     {"rindex", 0.0},
     {"hinferred", 0.0},
     {"linferred", 0.0},
     {"rinferred", 0.0},
     {"lcurl_thumb", k_curl_unknown},
     {"lcurl_index", k_curl_unknown},
     {"lcurl_middle", k_curl_unknown},
     {"lcurl_ring", k_curl_unknown},
     {"lcurl_little", k_curl_unknown},
     {"rcurl_thumb", k_curl_unknown},
     {"rcurl_index", k_curl_unknown},
     {"rcurl_middle", k_curl_unknown},
     {"rcurl_ring", k_curl_unknown},
     {"rcurl_little", k_curl_unknown}}};
constexpr std::size_t k_trigger_begin = k_columns.size();
constexpr std::size_t k_inferred_begin = k_trigger_begin + 2;  // the head's, the hands'
constexpr std::size_t k_curl_begin = k_inferred_begin + 1 + 2;
constexpr std::size_t k_always_written = k_inferred_begin;  // columns; others if they say something

// One line's cells in the order of k_columns and k_optional_columns.
using Cells = std::array<double, k_columns.size() + k_optional_columns.size()>;
const char* column_name(std::size_t cell) {
    return cell < k_columns.size() ? k_columns[cell]
                                   : k_optional_columns[cell - k_columns.size()].name;
}

// A device that was not tracked.
hh::Pose lost_pose() {
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    return {{k_nan, k_nan, k_nan}, hh::Quat{k_nan, k_nan, k_nan, k_nan}};
}

// Reads lines into samples; the first bad cell is kept as the error.
class RowReader {
  public:
    explicit RowReader(std::string file) : file_(std::move(file)) {}

    bool read(const Cells& cells, std::size_t line, RecordedSample& sample) {
        line_ = line;
        sample.t_s = cells[0];
        bool is_good =
            check(0, std::abs(cells[0]) <= k_max_time_s, "a time within 1e12 s", cells) &&
            read_pose(cells, k_head_begin, sample.head);
        for (std::size_t hand = 0; hand < sample.hands.size() && is_good; ++hand) {
            is_good = read_hand(cells, hand, sample.hands[hand]);
        }
        return is_good && read_flag(cells, k_inferred_begin, sample.is_head_inferred);
    }

    bool refuse(std::string expected) {
        error_ = FileError{file_, "line " + std::to_string(line_), std::move(expected)};
        return false;
    }

    const std::optional<FileError>& error() const { return error_; }

  private:
    bool check(std::size_t cell, bool is_good, const char* expected, const Cells& cells) {
        return is_good || refuse(std::string("expected ") + expected + " under \"" +
                                 column_name(cell) + "\", found " + std::to_string(cells[cell]));
    }

    bool read_pose(const Cells& cells, std::size_t begin, hh::Pose& pose) {
        for (std::size_t i = begin; i < begin + k_pose_cells; ++i) {
            if (std::isnan(cells[i])) {
                pose = lost_pose();
                return true;
            }
        }
        for (std::size_t i = begin; i < begin + 3; ++i) {
            if (!check(i, std::abs(cells[i]) <= k_max_recorded_m, "a coordinate within 1e6 m",
                       cells)) {
                return false;
            }
        }
        pose.position = hh::Vec3{cells[begin], cells[begin + 1], cells[begin + 2]};
        pose.rotation =
            hh::Quat{cells[begin + 3], cells[begin + 4], cells[begin + 5], cells[begin + 6]};
        if (pose.rotation == hh::Quat{}) {  // some recorders write zeros for a lost device
            pose = lost_pose();
            return true;
        }
        const hh::Quat& q = pose.rotation;
        const double length = std::sqrt((q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w));
        if (!(std::abs(length - 1.0) <= k_length_tolerance)) {
            return refuse(std::string("expected a quaternion of length 1 from \"") +
                          k_columns[begin + 3] + "\" on, found one of length " +
                          std::to_string(length));
        }
        if (std::abs(length - 1.0) > k_unit_tolerance) {
            pose.rotation = hh::normalized(pose.rotation);
        }
        return true;
    }

    bool read_flag(const Cells& cells, std::size_t cell, bool& flag) {
        flag = cells[cell] == 1.0;
        return check(cell, cells[cell] == 0.0 || flag, "0 or 1", cells);
    }

    bool read_curls(const Cells& cells, std::size_t side, hh_finger_curls& curls) {
        for (std::size_t f = 0; f < k_fingers; ++f) {
            const std::size_t cell = k_curl_begin + side * k_fingers + f;
            curls.fingers[f] = cells[cell];
            if (!check(cell,
                       curls.fingers[f] == k_curl_unknown ||
                           (curls.fingers[f] >= 0.0 && curls.fingers[f] <= 1.0),
                       "-1 or a number in [0, 1]", cells)) {
                return false;
            }
        }
        return true;
    }

    bool read_hand(const Cells& cells, std::size_t side, RecordedHand& hand) {
        const std::size_t buttons = k_hand_begin[side] + k_pose_cells;
        const std::size_t squeeze = buttons + 1;
        const std::size_t trigger = k_trigger_begin + side;
        const auto is_share = [&](std::size_t cell) {
            return check(cell, cells[cell] >= 0.0 && cells[cell] <= 1.0, "a number in [0, 1]",
                         cells);
        };
        // Written so that NaN fails: NaN is allowed only in poses.
        if (!read_pose(cells, k_hand_begin[side], hand.controller) ||
            !check(buttons,
                   cells[buttons] >= 0.0 && cells[buttons] <= k_max_buttons &&
                       cells[buttons] == std::floor(cells[buttons]),
                   "a mask of buttons, an integer in [0, 65535],", cells) ||
            !is_share(squeeze) || !is_share(trigger)) {
            return false;
        }
        hand.buttons = static_cast<int>(cells[buttons]);
        hand.squeeze = cells[squeeze];
        hand.trigger = cells[trigger];
        return read_flag(cells, k_inferred_begin + 1 + side, hand.is_inferred) &&
               read_curls(cells, side, hand.curls);
    }

    std::string file_;
    std::size_t line_ = 0;
    std::optional<FileError> error_;
};

void append_exact(std::string& text, double value) {
    if (std::isnan(value)) {
        text += "nan";
        return;
    }
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void write_pose(const hh::Pose& pose, double* cells) {
    const hh::Quat& q = pose.rotation;
    const std::array<double, k_pose_cells> values = {
        pose.position.x, pose.position.y, pose.position.z, q.x, q.y, q.z, q.w};
    std::ranges::copy(values, cells);
}

Cells cells_of(const RecordedSample& sample) {
    Cells cells{};
    cells[0] = sample.t_s;
    write_pose(sample.head, &cells[k_head_begin]);
    cells[k_inferred_begin] = sample.is_head_inferred ? 1.0 : 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
        const RecordedHand& hand = sample.hands[side];
        write_pose(hand.controller, &cells[k_hand_begin[side]]);
        cells[k_hand_begin[side] + k_pose_cells] = hand.buttons;
        cells[k_hand_begin[side] + k_pose_cells + 1] = hand.squeeze;
        cells[k_trigger_begin + side] = hand.trigger;
        cells[k_inferred_begin + 1 + side] = hand.is_inferred ? 1.0 : 0.0;
        std::ranges::copy(hand.curls.fingers, &cells[k_curl_begin + side * k_fingers]);
    }
    return cells;
}

// Which columns are written: the optional ones only if a sample differs from their missing value.
std::array<bool, Cells().size()> written_columns(const Recording& recording) {
    std::array<bool, Cells().size()> written{};
    std::fill_n(written.begin(), k_always_written, true);
    for (const RecordedSample& sample : recording.samples) {
        const Cells cells = cells_of(sample);
        for (std::size_t cell = k_always_written; cell < cells.size(); ++cell) {
            written[cell] =
                written[cell] || cells[cell] != k_optional_columns[cell - k_columns.size()].missing;
        }
    }
    return written;
}

}  // namespace

RecordedSample recorded(const hh::Sample& sample) {
    RecordedSample out;
    out.t_s = sample.time_s;
    out.head = sample.head_tracked || sample.head_inferred ? sample.head : lost_pose();
    out.is_head_inferred = sample.head_inferred != 0;
    for (std::size_t side = 0; side < 2; ++side) {
        const bool has_pose = sample.hand_tracked[side] != 0 || sample.hand_inferred[side] != 0;
        out.hands[side] = {.controller = has_pose ? sample.hands[side] : lost_pose(),
                           .buttons = sample.grab[side] ? k_button_grip : 0,
                           .squeeze = sample.squeeze[side],
                           .trigger = sample.trigger[side],
                           .is_inferred = sample.hand_inferred[side] != 0,
                           .curls = sample.curls[side]};
        for (double& curl : out.hands[side].curls.fingers) {
            curl = curl >= 0.0 ? std::min(curl, 1.0) : k_curl_unknown;
        }
    }
    return out;
}

Result<Recording> parse_recording(std::string_view text, const std::string& file) {
    const Result<NumericTable> table = parse_csv(text, file, NanCells::allowed);
    if (!table) {
        return table.error();
    }
    std::array<std::size_t, k_columns.size()> column_of{};
    for (std::size_t i = 0; i < k_columns.size(); ++i) {
        const std::optional<std::size_t> column = table.value().find_column(k_columns[i]);
        if (!column) {
            return FileError{file, "line " + std::to_string(table.value().header_line),
                             std::string("expected a column \"") + k_columns[i] + "\", found none"};
        }
        column_of[i] = *column;
    }
    constexpr std::size_t k_min_samples = 2;
    if (table.value().row_count() < k_min_samples) {
        return FileError{
            file, "",
            "expected at least 2 samples, found " + std::to_string(table.value().row_count())};
    }
    std::array<std::optional<std::size_t>, k_optional_columns.size()> optional_column;
    for (std::size_t i = 0; i < k_optional_columns.size(); ++i) {
        optional_column[i] = table.value().find_column(k_optional_columns[i].name);
    }
    Recording recording;
    recording.samples.resize(table.value().row_count());
    RowReader reader(file);
    for (std::size_t row = 0; row < recording.samples.size(); ++row) {
        Cells cells{};
        for (std::size_t i = 0; i < k_columns.size(); ++i) {
            cells[i] = table.value().at(row, column_of[i]);
        }
        for (std::size_t i = 0; i < k_optional_columns.size(); ++i) {
            cells[k_columns.size() + i] = optional_column[i]
                                              ? table.value().at(row, *optional_column[i])
                                              : k_optional_columns[i].missing;
        }
        RecordedSample& sample = recording.samples[row];
        if (!reader.read(cells, table.value().lines[row], sample)) {
            return *reader.error();
        }
        if (row > 0 && sample.t_s <= recording.samples[row - 1].t_s) {
            reader.refuse("expected a time after " +
                          std::to_string(recording.samples[row - 1].t_s) + ", found " +
                          std::to_string(sample.t_s));
            return *reader.error();
        }
    }
    return recording;
}

Result<Recording> load_recording(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    return parse_recording(text.value(), path.string());
}

std::optional<FileError> save_recording(const std::filesystem::path& path,
                                        const Recording& recording) {
    // 28 cells of up to 17 digits, so that nearly every recording needs one allocation.
    constexpr std::size_t k_bytes_per_row = 480;
    std::string text;
    text.reserve((recording.samples.size() + 1) * k_bytes_per_row);
    const auto is_written = written_columns(recording);
    const auto append_row = [&](auto&& append_cell) {
        for (std::size_t cell = 0; cell < is_written.size(); ++cell) {
            if (is_written[cell]) {
                text += cell == 0 ? "" : ",";
                append_cell(cell);
            }
        }
        text += '\n';
    };
    append_row([&](std::size_t cell) { text += column_name(cell); });
    for (const RecordedSample& sample : recording.samples) {
        const Cells cells = cells_of(sample);
        append_row([&](std::size_t cell) { append_exact(text, cells[cell]); });
    }
    return write_file_atomically(path, text);
}

}  // namespace handhold
