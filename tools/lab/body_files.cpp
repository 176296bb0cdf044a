#include "tools/lab/body_files.hpp"

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "engine/core/text_file.hpp"
#include "engine/io/csv.hpp"

namespace handhold::lab {
namespace {

constexpr std::size_t k_cells = 23;
constexpr std::size_t k_head_cell = 2;
constexpr std::array<std::size_t, k_hand_count> k_hand_cells = {9, 16};
constexpr double k_furthest_m = 1e4;
constexpr double k_length_tolerance = 0.01;

std::string line_of(std::size_t row) { return "line " + std::to_string(row + 2); }

// True if the seven numbers of a pose are NaN: the device is lost.
bool is_lost(const NumericTable& table, std::size_t row, std::size_t first) {
    constexpr std::size_t k_pose_cells = 7;
    for (std::size_t i = 0; i < k_pose_cells; ++i) {
        if (!std::isnan(table.at(row, first + i))) {
            return false;
        }
    }
    return true;
}

// False if the numbers are not a valid pose.
bool read_pose(const NumericTable& table, std::size_t row, std::size_t first, Pose& pose) {
    const auto cell = [&](std::size_t i) { return table.at(row, first + i); };
    pose.position = Vec3(cell(0), cell(1), cell(2));
    pose.rotation = Quat(cell(6), cell(3), cell(4), cell(5));
    const double length = pose.rotation.norm();
    pose.rotation.normalize();
    return (pose.position.array().abs() <= k_furthest_m).all() &&
           std::abs(length - 1.0) <= k_length_tolerance;
}

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = text.find(at);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) {
            return parts;
        }
        text.remove_prefix(end + 1);
    }
}

bool read_number(std::string_view text, double& value) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && std::isfinite(value);
}

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines = split(text, '\n');
    for (std::string_view& line : lines) {
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
    }
    while (!lines.empty() && lines.back().empty()) {
        lines.pop_back();
    }
    return lines;
}

// Indices of the columns in use.
struct CalibColumns {
    static constexpr std::array<const char*, 5> k_names = {"clip", "eye_height", "upper_arm",
                                                           "forearm", "shoulder_width"};
    std::array<std::size_t, k_names.size()> place{};
    std::size_t count = 0;
};

std::optional<std::string> find_columns(std::string_view header, CalibColumns& columns) {
    const std::vector<std::string_view> names = split(header, ',');
    columns.count = names.size();
    for (std::size_t i = 0; i < CalibColumns::k_names.size(); ++i) {
        std::size_t place = 0;
        while (place < names.size() && names[place] != CalibColumns::k_names[i]) {
            ++place;
        }
        if (place == names.size()) {
            return std::string("expected a column \"") + CalibColumns::k_names[i] + "\"";
        }
        columns.place[i] = place;
    }
    return std::nullopt;
}

}  // namespace

Result<std::vector<BodySample>> load_body_samples(const std::filesystem::path& path) {
    const Result<NumericTable> read = load_csv(path, NanCells::allowed);
    if (!read) {
        return read.error();
    }
    const NumericTable& table = read.value();
    if (table.columns.size() < k_cells) {
        return FileError{path.string(), "line 1",
                         "expected 23 columns (clip, t, head, left and right hand), found " +
                             std::to_string(table.columns.size())};
    }
    if (table.row_count() == 0) {
        return FileError{path.string(), "line 2", "expected a row"};
    }
    std::vector<BodySample> samples(table.row_count());
    for (std::size_t row = 0; row < samples.size(); ++row) {
        BodySample& sample = samples[row];
        const double clip = table.at(row, 0);
        if (!(clip == std::floor(clip) && std::abs(clip) <= 1e9)) {
            return FileError{path.string(), line_of(row), "expected a whole number in column clip"};
        }
        sample.clip = static_cast<std::int64_t>(clip);
        sample.t_s = table.at(row, 1);
        if (!std::isfinite(sample.t_s) || (row > 0 && samples[row - 1].clip == sample.clip &&
                                           !(sample.t_s > samples[row - 1].t_s))) {
            return FileError{path.string(), line_of(row), "expected t to increase within a clip"};
        }
        bool good = read_pose(table, row, k_head_cell, sample.head_ps);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const std::size_t first = k_hand_cells[side];
            if (is_lost(table, row, first)) {
                sample.is_lost[side] = true;
            } else {
                good = good && read_pose(table, row, first, sample.hands_ps[side]);
            }
        }
        if (!good) {
            return FileError{path.string(), line_of(row),
                             "expected positions within 1e4 m and quaternions of length 1, or a "
                             "wrist of seven nan"};
        }
    }
    return samples;
}

Result<MeasuresOfClips> load_body_measures(const std::filesystem::path& path) {
    const Result<std::string> read = read_file(path);
    if (!read) {
        return read.error();
    }
    const std::vector<std::string_view> lines = lines_of(read.value());
    CalibColumns columns;
    if (const auto objection =
            find_columns(lines.empty() ? std::string_view() : lines[0], columns)) {
        return FileError{path.string(), "line 1", *objection};
    }
    MeasuresOfClips measures;
    for (std::size_t row = 0; row + 1 < lines.size(); ++row) {
        const std::vector<std::string_view> cells = split(lines[row + 1], ',');
        if (cells.size() != columns.count) {
            return FileError{
                path.string(), line_of(row),
                "expected as many cells as the header has, found " + std::to_string(cells.size())};
        }
        std::array<double, CalibColumns::k_names.size()> numbers{};
        bool is_measured = true;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            if (i > 0 && cells[columns.place[i]].empty()) {
                is_measured = false;
                continue;
            }
            const bool good = read_number(cells[columns.place[i]], numbers[i]) &&
                              (i == 0 ? numbers[i] == std::floor(numbers[i])
                                      : numbers[i] >= 0.05 && numbers[i] <= 5.0);
            if (!good) {
                return FileError{path.string(), line_of(row),
                                 std::string("expected ") +
                                     (i == 0 ? "a whole number" : "a length of 0.05 to 5 m") +
                                     " in column " + CalibColumns::k_names[i]};
            }
        }
        std::optional<BodyMeasures> one;
        if (is_measured) {
            one = BodyMeasures{.eye_height_m = numbers[1],
                               .shoulder_width_m = numbers[4],
                               .upper_arm_m = numbers[2],
                               .forearm_m = numbers[3]};
        }
        if (!measures.emplace(static_cast<std::int64_t>(numbers[0]), one).second) {
            return FileError{path.string(), line_of(row), "expected each clip once"};
        }
    }
    return measures;
}

}  // namespace handhold::lab
