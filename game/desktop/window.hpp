#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "game/desktop/gamepad.hpp"
#include "game/devices/desktop_body.hpp"
#include "game/devices/play_settings.hpp"
#include "game/mesh/image.hpp"
#include "game/ui/ui_input.hpp"

namespace handhold {

// Keys with a function other than movement.
enum class PlayKey : std::uint8_t { help, inspector, menu, view, free_mouse, pause, step, leave };

// Events at a window since the last poll.
struct WindowEvents {
    DesktopInput input;  // keyboard and, while the window holds it, mouse
    UiInput ui;
    std::optional<GamepadState> gamepad;  // the first connected one
    std::vector<PlayKey> pressed;         // keys in the order in which they were pressed
    bool rewinds = false;                 // the rewind key is held down
    bool quit = false;
};

// A window that shows pictures, with keyboard, mouse and a gamepad. Pictures keep their aspect
// ratio. The only class that uses SDL. A program may have one window at a time.
class Window {
  public:
    // Null, with the reason in `why_not`, if there is no display.
    static std::unique_ptr<Window> open(const std::string& title, int width_px, int height_px,
                                        std::string& why_not);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    WindowEvents poll(const PlaySettings& settings);
    void show(const Image& picture);
    // Time between two pictures of the display, s; 1/60 if it is unknown.
    double picture_s() const;
    // true: the mouse is hidden and controls view and grips while the window has focus. false: the
    // mouse is a pointer.
    void hold_mouse(bool held);
    void set_title(const std::string& title);

  private:
    struct Impl;
    explicit Window(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
