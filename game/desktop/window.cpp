#include "game/desktop/window.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <SDL.h>

namespace handhold {
namespace {

constexpr double k_wheel_m = 0.04;  // movement of a held body per notch

constexpr std::array<std::pair<SDL_Scancode, PlayKey>, 8> k_play_keys = {{
    {SDL_SCANCODE_F1, PlayKey::help},
    {SDL_SCANCODE_F2, PlayKey::inspector},
    {SDL_SCANCODE_F3, PlayKey::menu},
    {SDL_SCANCODE_F4, PlayKey::view},
    {SDL_SCANCODE_TAB, PlayKey::free_mouse},
    {SDL_SCANCODE_P, PlayKey::pause},
    {SDL_SCANCODE_O, PlayKey::step},
    {SDL_SCANCODE_ESCAPE, PlayKey::leave},
}};
// SDL's scan codes, by UiKey.
constexpr std::array<SDL_Scancode, static_cast<std::size_t>(UiKey::count)> k_ui_keys = {
    SDL_SCANCODE_TAB,    SDL_SCANCODE_LEFT,   SDL_SCANCODE_RIGHT,     SDL_SCANCODE_UP,
    SDL_SCANCODE_DOWN,   SDL_SCANCODE_PAGEUP, SDL_SCANCODE_PAGEDOWN,  SDL_SCANCODE_HOME,
    SDL_SCANCODE_END,    SDL_SCANCODE_DELETE, SDL_SCANCODE_BACKSPACE, SDL_SCANCODE_RETURN,
    SDL_SCANCODE_ESCAPE, SDL_SCANCODE_A,      SDL_SCANCODE_C,         SDL_SCANCODE_V,
    SDL_SCANCODE_X};

bool is_down(const Uint8* keys, SDL_Scancode key) { return keys[key] != 0; }
double axis(const Uint8* keys, SDL_Scancode less, SDL_Scancode more) {
    return (is_down(keys, more) ? 1.0 : 0.0) - (is_down(keys, less) ? 1.0 : 0.0);
}

}  // namespace

struct Window::Impl {
    SDL_Window* window = nullptr;
    SDL_Renderer* renderer = nullptr;
    SDL_Texture* texture = nullptr;
    SDL_GameController* gamepad = nullptr;
    int texture_width = 0;
    int texture_height = 0;
    bool holds_mouse = false;
    UiInput ui;  // mouse position and buttons, which persist from poll to poll; the rest is unused

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        SDL_GameControllerClose(gamepad);
        SDL_DestroyTexture(texture);
        SDL_DestroyRenderer(renderer);
        SDL_DestroyWindow(window);
        SDL_Quit();
    }
    void take_event(const SDL_Event& event, const PlaySettings& settings, WindowEvents& events);
    void take_window_event(const SDL_WindowEvent& event, WindowEvents& events);
    void take_mouse(const SDL_Event& event, const PlaySettings& settings, WindowEvents& events);
    void read_keys(const PlaySettings& settings, WindowEvents& events) const;
    std::optional<GamepadState> read_gamepad_state() const;
};

void Window::Impl::take_window_event(const SDL_WindowEvent& event, WindowEvents& events) {
    if (event.windowID != SDL_GetWindowID(window)) {
        return;
    }
    switch (event.event) {
        case SDL_WINDOWEVENT_CLOSE:
            events.quit = true;
            break;
        case SDL_WINDOWEVENT_FOCUS_LOST:  // release the mouse for other windows
            SDL_SetRelativeMouseMode(SDL_FALSE);
            ui.buttons = {};
            break;
        case SDL_WINDOWEVENT_FOCUS_GAINED:
            SDL_SetRelativeMouseMode(holds_mouse ? SDL_TRUE : SDL_FALSE);
            break;
        default:
            break;
    }
}

void Window::Impl::take_mouse(const SDL_Event& event, const PlaySettings& settings,
                              WindowEvents& events) {
    DesktopInput& input = events.input;
    const auto ui_button = [](Uint8 button) -> std::size_t {
        return button == SDL_BUTTON_LEFT ? 0 : button == SDL_BUTTON_RIGHT ? 1 : 2;
    };
    if (event.type == SDL_MOUSEMOTION) {
        ui.mouse_px = {static_cast<float>(event.motion.x), static_cast<float>(event.motion.y)};
        if (holds_mouse) {
            input.turn_left_rad -= settings.mouse_rad_per_px * event.motion.xrel;
            input.look_up_rad -= settings.mouse_rad_per_px * event.motion.yrel;
        }
    } else if (event.type == SDL_MOUSEBUTTONDOWN) {
        ui.buttons[ui_button(event.button.button)] = true;
    } else if (event.type == SDL_MOUSEBUTTONUP) {
        ui.buttons[ui_button(event.button.button)] = false;
        input.opened[0] = input.opened[0] || event.button.button == SDL_BUTTON_LEFT;
        input.opened[1] = input.opened[1] || event.button.button == SDL_BUTTON_RIGHT;
    } else if (holds_mouse) {
        input.farther_m += k_wheel_m * event.wheel.y;
    } else {
        events.ui.wheel += static_cast<float>(event.wheel.y);
    }
}

void Window::Impl::take_event(const SDL_Event& event, const PlaySettings& settings,
                              WindowEvents& events) {
    switch (event.type) {
        case SDL_QUIT:
            events.quit = true;
            break;
        case SDL_WINDOWEVENT:
            take_window_event(event.window, events);
            break;
        case SDL_KEYDOWN:
            for (const auto& [scancode, key] : k_play_keys) {
                if (event.key.repeat == 0 && event.key.keysym.scancode == scancode) {
                    events.pressed.push_back(key);
                }
            }
            break;
        case SDL_TEXTINPUT:
            events.ui.text += event.text.text;
            break;
        case SDL_MOUSEMOTION:
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
        case SDL_MOUSEWHEEL:
            take_mouse(event, settings, events);
            break;
        case SDL_CONTROLLERDEVICEADDED:
            if (gamepad == nullptr) {
                gamepad = SDL_GameControllerOpen(event.cdevice.which);
            }
            break;
        case SDL_CONTROLLERDEVICEREMOVED:
            if (gamepad != nullptr && SDL_GameControllerGetAttached(gamepad) == SDL_FALSE) {
                SDL_GameControllerClose(gamepad);
                gamepad = nullptr;
            }
            break;
        default:
            break;
    }
}

void Window::Impl::read_keys(const PlaySettings& settings, WindowEvents& events) const {
    DesktopInput& input = events.input;
    const Uint8* const keys = SDL_GetKeyboardState(nullptr);
    if (holds_mouse) {
        const Uint32 buttons = SDL_GetMouseState(nullptr, nullptr);
        input.grip = {(buttons & SDL_BUTTON_LMASK) != 0, (buttons & SDL_BUTTON_RMASK) != 0};
    }
    input.move = {axis(keys, SDL_SCANCODE_A, SDL_SCANCODE_D),
                  axis(keys, SDL_SCANCODE_Q, SDL_SCANCODE_E),
                  axis(keys, SDL_SCANCODE_W, SDL_SCANCODE_S)};
    input.hurry = is_down(keys, SDL_SCANCODE_LSHIFT) || is_down(keys, SDL_SCANCODE_RSHIFT);
    input.brake = is_down(keys, SDL_SCANCODE_SPACE);
    if (settings.turn == TurnKind::smooth) {
        input.smooth_turn = axis(keys, SDL_SCANCODE_C, SDL_SCANCODE_Z);
    }
    events.rewinds = is_down(keys, SDL_SCANCODE_R);
    for (std::size_t i = 0; i < k_ui_keys.size(); ++i) {
        events.ui.keys[i] = is_down(keys, k_ui_keys[i]);
    }
    const SDL_Keymod held = SDL_GetModState();
    events.ui.ctrl = (held & KMOD_CTRL) != 0;
    events.ui.shift = (held & KMOD_SHIFT) != 0;
    events.ui.mouse_px = ui.mouse_px;
    events.ui.buttons = ui.buttons;
}

std::optional<GamepadState> Window::Impl::read_gamepad_state() const {
    if (gamepad == nullptr) {
        return std::nullopt;
    }
    constexpr double k_full = 32767.0;
    const auto value = [&](SDL_GameControllerAxis axis_id) {
        return std::max(-1.0, SDL_GameControllerGetAxis(gamepad, axis_id) / k_full);
    };
    const auto pressed = [&](SDL_GameControllerButton button) {
        return SDL_GameControllerGetButton(gamepad, button) != 0;
    };
    GamepadState state;
    state.left_stick = {value(SDL_CONTROLLER_AXIS_LEFTX), value(SDL_CONTROLLER_AXIS_LEFTY)};
    state.right_stick = {value(SDL_CONTROLLER_AXIS_RIGHTX), value(SDL_CONTROLLER_AXIS_RIGHTY)};
    state.triggers = {value(SDL_CONTROLLER_AXIS_TRIGGERLEFT),
                      value(SDL_CONTROLLER_AXIS_TRIGGERRIGHT)};
    state.shoulders = {pressed(SDL_CONTROLLER_BUTTON_LEFTSHOULDER),
                       pressed(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER)};
    state.pad = {pressed(SDL_CONTROLLER_BUTTON_DPAD_UP), pressed(SDL_CONTROLLER_BUTTON_DPAD_DOWN),
                 pressed(SDL_CONTROLLER_BUTTON_DPAD_LEFT),
                 pressed(SDL_CONTROLLER_BUTTON_DPAD_RIGHT)};
    state.brake = pressed(SDL_CONTROLLER_BUTTON_A);
    state.hurry = pressed(SDL_CONTROLLER_BUTTON_LEFTSTICK);
    return state;
}

Window::Window(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Window::~Window() = default;

std::unique_ptr<Window> Window::open(const std::string& title, int width_px, int height_px,
                                     std::string& why_not) {
    auto impl = std::make_unique<Impl>();
    constexpr auto k_anywhere = static_cast<int>(SDL_WINDOWPOS_UNDEFINED);
    const auto failed = [&] {
        why_not = SDL_GetError();
        return nullptr;
    };
    // The game's renderer has its own OpenGL context. A second context for the window would
    // conflict with it on this thread.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        return failed();
    }
    // Without a display, SDL selects a driver that shows nothing. That counts as no display, unless
    // the user requested the driver.
    const std::string_view driver = SDL_GetCurrentVideoDriver();
    if (SDL_getenv("SDL_VIDEODRIVER") == nullptr && (driver == "offscreen" || driver == "dummy")) {
        why_not = "no display";
        return nullptr;
    }
    SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER);  // if this fails, there are no gamepads
    impl->window = SDL_CreateWindow(title.c_str(), k_anywhere, k_anywhere, width_px, height_px,
                                    SDL_WINDOW_RESIZABLE);
    if (impl->window == nullptr) {
        return failed();
    }
    impl->renderer = SDL_CreateRenderer(impl->window, -1, SDL_RENDERER_SOFTWARE);
    if (impl->renderer == nullptr) {
        return failed();
    }
    SDL_RenderSetLogicalSize(impl->renderer, width_px, height_px);
    std::unique_ptr<Window> window(new Window(std::move(impl)));
    window->hold_mouse(true);
    return window;
}

void Window::hold_mouse(bool held) {
    impl_->holds_mouse = held;
    SDL_SetRelativeMouseMode(held ? SDL_TRUE : SDL_FALSE);
}

void Window::set_title(const std::string& title) {
    SDL_SetWindowTitle(impl_->window, title.c_str());
}

WindowEvents Window::poll(const PlaySettings& settings) {
    WindowEvents events;
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0) {
        if (event.type == SDL_KEYDOWN && event.key.repeat == 0 && settings.turn == TurnKind::snap) {
            events.input.snap_turns += event.key.keysym.scancode == SDL_SCANCODE_Z   ? 1
                                       : event.key.keysym.scancode == SDL_SCANCODE_C ? -1
                                                                                     : 0;
        }
        impl_->take_event(event, settings, events);
    }
    impl_->read_keys(settings, events);
    events.gamepad = impl_->read_gamepad_state();
    return events;
}

double Window::picture_s() const {
    constexpr int k_usual_hz = 60;
    SDL_DisplayMode mode{};
    const int display = SDL_GetWindowDisplayIndex(impl_->window);
    const bool is_known = display >= 0 && SDL_GetCurrentDisplayMode(display, &mode) == 0;
    return 1.0 / std::max(1, is_known && mode.refresh_rate > 0 ? mode.refresh_rate : k_usual_hz);
}

void Window::show(const Image& picture) {
    Impl& impl = *impl_;
    SDL_SetRenderDrawColor(impl.renderer, 0, 0, 0, 255);
    SDL_RenderClear(impl.renderer);
    if (impl.texture == nullptr || impl.texture_width != picture.width_px ||
        impl.texture_height != picture.height_px) {
        SDL_DestroyTexture(impl.texture);
        impl.texture =
            SDL_CreateTexture(impl.renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING,
                              picture.width_px, picture.height_px);
        impl.texture_width = picture.width_px;
        impl.texture_height = picture.height_px;
        SDL_SetTextureBlendMode(impl.texture, SDL_BLENDMODE_NONE);
        SDL_RenderSetLogicalSize(impl.renderer, picture.width_px, picture.height_px);
    }
    if (impl.texture != nullptr) {
        SDL_UpdateTexture(impl.texture, nullptr, picture.rgba.data(), 4 * picture.width_px);
        SDL_RenderCopy(impl.renderer, impl.texture, nullptr, nullptr);
    }
    SDL_RenderPresent(impl.renderer);
}

}  // namespace handhold
