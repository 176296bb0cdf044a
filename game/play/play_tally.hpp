#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <handhold/handhold.hpp>

#include "game/devices/headset_reading.hpp"

// Statistics of an interactive session: distances that players moved by their hands, and the costs
// of runtime and renderer.
namespace handhold {

struct PlayFigures {
    std::uint64_t frames = 0;
    double played_s = 0.0;
    // Path of the play space, relative to the scene's reference velocity.
    double path_m = 0.0;
    double climbed_m = 0.0;  // part of path_m during which a hand gripped a surface
    // Displacement from start to end in the world, including the motion of the scene's reference
    // velocity.
    hh::Vec3 moved_m{};
    std::uint64_t grips = 0;  // grips of surfaces
    // Hand over hand: one hand gripped while the other, which had gripped before, still held.
    std::uint64_t hand_changes = 0;
    std::uint64_t hands_closed = 0;
    std::uint64_t hands_gripped = 0;       // grabs that gripped something
    std::vector<std::uint64_t> fallbacks;  // indexed as hh_fallback_name
};

class PlayTally {
  public:
    // Call after each frame of the world. `runtime_us`: cost of the frame.
    void add_frame(const hh::World& world, hh::Player player, double runtime_us, double dt_s);
    // Call after each picture, with the costs of drawing and of showing it.
    void add_picture(double draw_us, double show_us);

    const PlayFigures& figures() const { return figures_; }
    // The latest costs, for a live display.
    double runtime_us() const { return runtime_us_.empty() ? 0.0 : runtime_us_.back(); }
    double draw_us() const { return draw_us_.empty() ? 0.0 : draw_us_.back(); }

    // The text of report.json: figures, fallbacks by name, and times of runtime, drawing and
    // showing (median, p99 and max in microseconds). `state_hash`: text from format_hash.
    std::string report_json(const std::string& scene, const std::string& state_hash) const;
    // Two lines for a terminal: distances climbed and frame costs.
    std::string summary() const;

  private:
    void add_grips(const hh::World& world, hh::Player player);

    PlayFigures figures_;
    std::optional<hh::Vec3> start_ws_;
    hh::Vec3 last_ws_{};
    std::array<bool, 2> grips_{};           // whether each hand gripped in the previous frame
    std::optional<std::size_t> last_hand_;  // hand whose grip began last
    std::vector<double> runtime_us_, draw_us_, show_us_;
};

// Additional figures of a session in a headset.
struct HeadsetFigures {
    HeadsetReading reading;  // the last reading
    bool has_focus = false;
    bool shows_panel = false;
    // How often the XR runtime was lost, and recovered.
    std::uint64_t losses = 0;
    std::uint64_t pictures = 0;             // counted once for both eyes
    std::array<std::uint64_t, 2> shakes{};  // haptic pulses, by hh::Side
};

// One line of JSON with the current state: time, head, hands with what they hold, metres climbed.
// It serves programs that control the game without seeing its pictures.
std::string status_line(const hh::World& world, hh::Player player, const PlayFigures& figures,
                        bool can_reach, const HeadsetFigures* headset = nullptr);

}  // namespace handhold
