#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "game/render/player_models.hpp"
#include "game/scene/scene.hpp"
#include "game/session/run_log.hpp"

namespace handhold {

// A picture of a run as a PNG file in memory.
struct FilmShot {
    std::string name;  // of the file, without folder and extension
    std::string caption;
    std::vector<std::uint8_t> png;
};

struct FilmSettings {
    int width_px = 960;  // of pictures
    int height_px = 540;
    int video_width_px = 640;
    int video_height_px = 360;
    double video_fps = 24.0;
    double longest_video_s = 40.0;  // of the session
    int shots = 8;  // at most, spread over the session, at moments of grabbing where there are any
    std::filesystem::path video;  // empty: no video
    PlayerModels models;
};

// Pictures and a video of a session, drawn while it is played: first person, and from outside. Only
// reads the world.
class SessionFilm {
  public:
    // Null, with the reason, where nothing can be drawn on this machine. `scene` must outlive the
    // film. `session_s` is how long it will be.
    static std::unique_ptr<SessionFilm> open(const Scene& scene, double session_s,
                                             const FilmSettings& settings, std::string& why_not);
    ~SessionFilm();

    // After each frame.
    void watch(const FrameLog& frame);
    // Ends the video. `why_not` is set where there is none although one was asked for.
    std::vector<FilmShot> finish(std::string& why_not);

  private:
    struct Impl;
    explicit SessionFilm(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
