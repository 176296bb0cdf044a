#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace handhold {

enum class UiKey : std::uint8_t {
    tab,
    left,
    right,
    up,
    down,
    page_up,
    page_down,
    home,
    end,
    del,
    backspace,
    enter,
    escape,
    a,
    c,
    v,
    x,
    count
};

// Current input for the panels. Positions are in pixels of the picture.
struct UiInput {
    std::array<float, 2> mouse_px = {-1e6F, -1e6F};  // far away: no mouse
    std::array<bool, 3> buttons{};                   // left, right, middle
    float wheel = 0.0F;                              // notches since the last call
    std::array<bool, static_cast<std::size_t>(UiKey::count)> keys{};
    bool ctrl = false;
    bool shift = false;
    std::string text;  // text typed since the last call, UTF-8
};

}  // namespace handhold
