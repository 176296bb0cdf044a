#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "game/run/run_log.hpp"
#include "game/scene/scene.hpp"
#include "game/view/player_models.hpp"

namespace handhold {

// One picture of a run, as a PNG file in memory.
struct FilmShot {
    std::string name;  // file name, without folder and extension
    std::string caption;
    std::vector<std::uint8_t> png;
};

struct FilmSettings {
    int width_px = 960;  // size of the pictures
    int height_px = 540;
    int video_width_px = 640;
    int video_height_px = 360;
    double video_fps = 24.0;
    double longest_video_s = 40.0;  // the video covers at most this much of the session
    // Maximum number of pictures, spread over the session. If possible, a picture shows a hand that
    // has just grabbed or holds another player.
    int shots = 8;
    std::filesystem::path video;  // empty: no video
    PlayerModels models;
};

// Pictures and a video of a session, from the player's eyes and from outside, drawn while it is
// played. The outside view shows the nearest other player too, if one is near. Only reads the
// world.
class SessionFilm {
  public:
    // Null, with the reason in `why_not`, if nothing can be drawn on this machine. `scene` must
    // outlive the film. `session_s`: expected length of the session.
    static std::unique_ptr<SessionFilm> open(const Scene& scene, double session_s,
                                             const FilmSettings& settings, std::string& why_not);
    ~SessionFilm();

    // Call after each frame.
    void watch(const FrameLog& frame);
    // The pictures drawn so far.
    const std::vector<FilmShot>& shots() const;
    // Finishes the video. Sets `why_not` if a video was requested and could not be written.
    std::vector<FilmShot> finish(std::string& why_not);

  private:
    struct Impl;
    explicit SessionFilm(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
