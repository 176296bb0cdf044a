#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "game/desktop_body.hpp"
#include "game/render/image.hpp"

namespace handhold {

// What was done at a window since it was last asked.
struct WindowEvents {
    DesktopInput input;
    bool help = false;  // asked for, or to go away
    bool quit = false;
};

// A window that shows pictures and lines of text, with the keyboard and the mouse, which it keeps
// while it is in front. The only place that names SDL. One at a time.
class Window {
  public:
    // Nothing, with the reason, where there is no display.
    static std::unique_ptr<Window> open(const std::string& title, int width_px, int height_px,
                                        std::string& why_not);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    WindowEvents poll();
    // The picture, as large as the window, a mark in its middle, lit where he may reach, and text
    // (ASCII) in its upper left corner.
    void show(const Image& picture, bool may_reach, std::string_view text);

  private:
    struct Impl;
    explicit Window(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
