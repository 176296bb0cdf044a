#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <handhold/handhold.hpp>

#include "game/files/file_tools.hpp"
#include "game/session/finger_curls.hpp"

// Recorded sessions of a headset and two controllers: docs/reference/recording_format.md.
namespace handhold {

// Bits of RecordedHand::buttons.
constexpr int k_button_trigger = 2;
constexpr int k_button_grip = 4;
constexpr int k_button_menu = 8;
// A hand grabs while one of these buttons is down.
constexpr int k_grab_buttons = k_button_trigger | k_button_grip;

struct RecordedHand {
    // Pose of the device in tracking space: metres, floor at y = 0; all NaN while it was not
    // tracked.
    hh::Pose controller = hh::k_origin;
    int buttons = 0;                          // mask of k_button_*, [0, 65535]
    double squeeze = 0.0;                     // [0, 1]; ControllerSample::squeeze
    double trigger = 0.0;                     // [0, 1]; ControllerSample::trigger
    bool is_inferred = false;                 // hh::Sample::hand_inferred
    hh_finger_curls curls = k_curls_unknown;  // each in [0, 1], or k_curl_unknown
};

struct RecordedSample {
    double t_s = 0.0;  // strictly increasing; may start at any time
    // Point between the eyes, in tracking space; all NaN while it was not tracked.
    hh::Pose head = hh::k_origin;
    std::array<RecordedHand, 2> hands;  // left, right
    bool is_head_inferred = false;      // hh::Sample::head_inferred
};

// Converts a sample to what a headset would have recorded. A hand that grabs holds k_button_grip
// down.
RecordedSample recorded(const hh::Sample& sample);

struct Recording {
    std::vector<RecordedSample> samples;  // two or more; gaps and jitter are normal
};

// Errors that name the line: a required column that is missing, a line with too few or too many
// cells, a time that does not increase, a time beyond 1e12 s, a coordinate beyond 1e6 m, a
// quaternion whose length differs from 1 by more than 1e-2 (others are normalised), buttons that
// are no integer in [0, 65535], a squeeze or trigger outside [0, 1], a curl outside [0, 1] other
// than -1, a flag other than 0 and 1. A file with less than two samples is an error too. Columns
// may come in any order; other columns of numbers are ignored. If any of a pose's seven cells is
// NaN, or if its quaternion is all zeros, the device was not tracked and all seven become NaN.
Result<Recording> load_recording(const std::filesystem::path& path);
// Parses text in memory. `file`: name used in errors.
Result<Recording> parse_recording(std::string_view text, const std::string& file);

// Writes enough digits to keep every bit: a recording that was loaded is saved unchanged and
// replays to the same state hash. Returns the reason if the file cannot be written.
[[nodiscard]] std::optional<FileError> save_recording(const std::filesystem::path& path,
                                                      const Recording& recording);

}  // namespace handhold
