#pragma once

#include <memory>

#include "game/render/ui_picture.hpp"
#include "game/ui/ui_input.hpp"

// Panels over the game's picture. Dear ImGui lays them out and the renderer draws them into the
// picture, so they also appear in saved pictures and need no window.
namespace handhold {

// The functions of game/ui may be called between begin() and end(). At most one overlay may exist.
class Overlay {
  public:
    Overlay(int width_px, int height_px);
    ~Overlay();
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    // Sets the size from the next begin() on; letters keep their size.
    void resize(int width_px, int height_px);
    void begin(const UiInput& input, double dt_s);
    // Returns the panels as triangles; valid until the next begin().
    const UiPicture& end();

    // True while a text field of a panel has the focus, so that the game must ignore keyboard and
    // mouse.
    bool takes_keys() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
