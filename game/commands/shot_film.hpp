#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "game/commands/shot_list.hpp"
#include "game/scene/scene.hpp"
#include "game/view/player_models.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {

struct ShotFilmSettings {
    int width_px = 960;
    int height_px = 540;
    double video_fps = 30.0;
    PictureQuality quality = PictureQuality::fine;
    std::filesystem::path out;  // existing folder
    PlayerModels models;
};

// Draws the shots of one scene while its session is played: <name>.png or <name>.mp4 in the folder.
// Only reads the world.
class ShotFilm {
  public:
    // Null, with the reason in `why_not`, if nothing can be drawn on this machine. `scene` must
    // outlive the film.
    static std::unique_ptr<ShotFilm> open(const Scene& scene, std::vector<Shot> shots,
                                          const ShotFilmSettings& settings, std::string& why_not);
    ~ShotFilm();

    // End of the last shot, seconds of the session.
    double length_s() const;
    // Call after each frame.
    void watch(double t_s);
    // Ends the film. Returns the number of shots saved. `why_not`: the reason of the first failure,
    // if any.
    std::size_t finish(std::string& why_not);

  private:
    struct Impl;
    explicit ShotFilm(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
