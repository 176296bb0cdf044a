#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "game/render/player_models.hpp"
#include "game/scene/scene.hpp"
#include "game/view/shot_list.hpp"
#include "systems/frame.hpp"

namespace handhold {

struct ShotFilmSettings {
    int width_px = 960;
    int height_px = 540;
    double video_fps = 30.0;
    PictureQuality quality = PictureQuality::fine;
    std::filesystem::path out;  // a folder that is there
    PlayerModels models;
};

// Draws the shots of one scene while its session is played: <name>.png or <name>.mp4 in the folder.
// Only reads the world.
class ShotFilm {
  public:
    // Null, with the reason, where nothing can be drawn on this machine. Scene and caches, which
    // gizmos are read from, must outlive it.
    static std::unique_ptr<ShotFilm> open(const Scene& scene, const FrameCaches& caches,
                                          std::vector<Shot> shots, const ShotFilmSettings& settings,
                                          std::string& why_not);
    ~ShotFilm();

    // When the last shot ends.
    double length_s() const;
    // After each frame.
    void watch(double t_s);
    // How many shots were drawn and saved; `why_not` is the first reason where one was not.
    std::size_t finish(std::string& why_not);

  private:
    struct Impl;
    explicit ShotFilm(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
