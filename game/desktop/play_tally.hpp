#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/stats.hpp"
#include "components/world.hpp"
#include "game/headset/headset_reading.hpp"

// What a session at a window comes to: how far the player's hands carried him, and what the runtime
// and the renderer cost, each for itself.
namespace handhold {

struct PlayFigures {
    std::uint64_t frames = 0;
    double played_s = 0.0;
    double path_m = 0.0;          // of the play space, against the scene's reference velocity
    double climbed_m = 0.0;       // the part of it during which a hand gripped something that holds
    Vec3 moved_m = Vec3::Zero();  // from where he began to where he is, reference velocity included
    std::uint64_t grips = 0;      // of surfaces
    // Hand over hand: times that the next grip was the other hand's, begun while the one before
    // still held.
    std::uint64_t hand_changes = 0;
    StageStats totals;  // counters and fallbacks only
};

class PlayTally {
  public:
    // After a frame of the world; `runtime_us` is what the frame took.
    void add_frame(const World& world, const PlayerEntities& player, const StageStats& stats,
                   double runtime_us, double dt_s);
    // After a picture: what drawing took, and what showing it did.
    void add_picture(double draw_us, double show_us);

    const PlayFigures& figures() const { return figures_; }
    // The last ones, for a display that is read while it plays.
    double runtime_us() const { return runtime_us_.empty() ? 0.0 : runtime_us_.back(); }
    double draw_us() const { return draw_us_.empty() ? 0.0 : draw_us_.back(); }

    // report.json's text: the figures, times (median, p99, max in microseconds) of the runtime, of
    // drawing and of showing, fallbacks by name. `state_hash` as format_hash writes it.
    std::string report_json(const std::string& scene, const std::string& state_hash) const;
    // Two lines for a terminal: what was climbed, and frame costs.
    std::string summary() const;

  private:
    void add_grips(const World& world, const PlayerEntities& player);

    PlayFigures figures_;
    std::optional<Vec3> start_ws_;
    Vec3 last_ws_ = Vec3::Zero();
    std::array<bool, k_hand_count> grips_{};  // in the frame before
    std::optional<std::size_t> last_hand_;    // whose grip was begun last
    std::vector<double> runtime_us_, draw_us_, show_us_;
};

// What a headset has to say beside that.
struct HeadsetFigures {
    HeadsetReading reading;  // the last one
    bool has_focus = false;
    bool shows_panel = false;
    std::uint64_t losses = 0;                          // of the runtime, each found again
    std::uint64_t pictures = 0;                        // of both eyes
    std::array<std::uint64_t, k_hand_count> shakes{};  // by HandSide
};

// One line (JSON) of how it stands: time, head, hands with what they hold, metres climbed. For
// whoever drives the game from outside and cannot see its pictures.
std::string status_line(const World& world, const PlayerEntities& player,
                        const PlayFigures& figures, bool can_reach,
                        const HeadsetFigures* headset = nullptr);

}  // namespace handhold
