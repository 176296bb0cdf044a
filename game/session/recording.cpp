#include "game/session/recording.hpp"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/core/text_file.hpp"
#include "engine/io/csv.hpp"

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
// Columns that older recordings lack; their cells are 0 then. By HandSide, after the others.
constexpr std::array<const char*, k_hand_count> k_trigger_columns = {"lindex", "rindex"};

// One row's cells in the order of k_columns and k_trigger_columns.
using Cells = std::array<double, k_columns.size() + k_hand_count>;
const char* column_name(std::size_t cell) {
    return cell < k_columns.size() ? k_columns[cell] : k_trigger_columns[cell - k_columns.size()];
}

// A device that was not tracked.
Pose lost_pose() {
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    return {Vec3::Constant(k_nan), Quat(k_nan, k_nan, k_nan, k_nan)};
}

// Reads rows into samples; the first bad cell is kept as the error.
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
        return is_good;
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

    bool read_pose(const Cells& cells, std::size_t begin, Pose& pose) {
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
        pose.position = Vec3(cells[begin], cells[begin + 1], cells[begin + 2]);
        pose.rotation =
            Quat(cells[begin + 6], cells[begin + 3], cells[begin + 4], cells[begin + 5]);
        if (pose.rotation.coeffs().isZero(0.0)) {  // how some recorders write a lost device
            pose = lost_pose();
            return true;
        }
        const double length = pose.rotation.norm();
        if (!(std::abs(length - 1.0) <= k_length_tolerance)) {
            return refuse(std::string("expected a quaternion of length 1 from \"") +
                          k_columns[begin + 3] + "\" on, found one of length " +
                          std::to_string(length));
        }
        if (std::abs(length - 1.0) > k_unit_tolerance) {
            pose.rotation.normalize();
        }
        return true;
    }

    bool read_hand(const Cells& cells, std::size_t side, RecordedHand& hand) {
        const std::size_t buttons = k_hand_begin[side] + k_pose_cells;
        const std::size_t squeeze = buttons + 1;
        const std::size_t trigger = k_columns.size() + side;
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
        return true;
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

void append_pose(std::string& text, const Pose& pose) {
    const Quat& q = pose.rotation;
    for (const double value :
         {pose.position.x(), pose.position.y(), pose.position.z(), q.x(), q.y(), q.z(), q.w()}) {
        text += ',';
        append_exact(text, value);
    }
}

}  // namespace

RecordedSample recorded(const TrackingSample& sample) {
    RecordedSample out;
    out.t_s = sample.t_s;
    out.head = sample.head_ps;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ControllerSample& controller = sample.controllers[side];
        out.hands[side] = {controller.controller_ps, controller.grab ? k_button_grip : 0,
                           controller.squeeze, controller.trigger};
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
    std::array<std::optional<std::size_t>, k_hand_count> trigger_column;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        trigger_column[side] = table.value().find_column(k_trigger_columns[side]);
    }
    Recording recording;
    recording.samples.resize(table.value().row_count());
    RowReader reader(file);
    for (std::size_t row = 0; row < recording.samples.size(); ++row) {
        Cells cells{};
        for (std::size_t i = 0; i < k_columns.size(); ++i) {
            cells[i] = table.value().at(row, column_of[i]);
        }
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            if (trigger_column[side]) {
                cells[k_columns.size() + side] = table.value().at(row, *trigger_column[side]);
            }
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
    for (std::size_t cell = 0; cell < Cells().size(); ++cell) {
        text += text.empty() ? "" : ",";
        text += column_name(cell);
    }
    text += '\n';
    for (const RecordedSample& sample : recording.samples) {
        append_exact(text, sample.t_s);
        append_pose(text, sample.head);
        for (const RecordedHand& hand : sample.hands) {
            append_pose(text, hand.controller);
            text += ',';
            text += std::to_string(hand.buttons);
            text += ',';
            append_exact(text, hand.squeeze);
        }
        for (const RecordedHand& hand : sample.hands) {
            text += ',';
            append_exact(text, hand.trigger);
        }
        text += '\n';
    }
    return write_file_atomically(path, text);
}

}  // namespace handhold
