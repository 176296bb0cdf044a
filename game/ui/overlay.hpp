#pragma once

#include <memory>

#include "game/desktop/ui_input.hpp"
#include "game/render/ui_picture.hpp"

// Panels over the game's picture, by Dear ImGui: it lays them out, and the renderer draws them into
// the picture as it draws everything else, so that they are in saved pictures and need no window.
namespace handhold {

// Between begin() and end() the functions of game/ui may be called. One at a time.
class Overlay {
  public:
    Overlay(int width_px, int height_px);
    ~Overlay();
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    // Of what is laid out from the next begin() on; letters stay as large as they are.
    void resize(int width_px, int height_px);
    void begin(const UiInput& input, double dt_s);
    // The panels as triangles; good until the next begin().
    const UiPicture& end();

    // A panel takes what is typed or clicked: nobody else should.
    bool takes_keys() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
