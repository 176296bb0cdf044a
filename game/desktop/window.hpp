#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "game/desktop/desktop_body.hpp"
#include "game/desktop/gamepad.hpp"
#include "game/desktop/play_settings.hpp"
#include "game/desktop/ui_input.hpp"
#include "game/render/image.hpp"

namespace handhold {

// Keys that mean something besides moving, in the order in which they were pressed.
enum class PlayKey : std::uint8_t { help, inspector, menu, view, free_mouse, pause, step, leave };

// What was done at a window since it was last asked.
struct WindowEvents {
    DesktopInput input;  // of keyboard and, while the window holds it, mouse
    UiInput ui;
    std::optional<GamepadState> gamepad;  // the first one that is plugged in
    std::vector<PlayKey> pressed;
    bool rewinds = false;  // held down
    bool quit = false;
};

// A window that shows pictures, with the keyboard, the mouse and a gamepad. Pictures keep their
// shape whatever the window's. The only place that names SDL. One at a time.
class Window {
  public:
    // Nothing, with the reason, where there is no display.
    static std::unique_ptr<Window> open(const std::string& title, int width_px, int height_px,
                                        std::string& why_not);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    WindowEvents poll(const PlaySettings& settings);
    void show(const Image& picture);
    // Held: it looks about and grips, unseen, from whenever the window is in front. Else it points.
    void hold_mouse(bool held);
    void set_title(const std::string& title);

  private:
    struct Impl;
    explicit Window(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
