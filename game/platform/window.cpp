#include "game/platform/window.hpp"

#include <algorithm>
#include <vector>

#include <SDL.h>

// Its functions are defined in its header, and not all are used.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

namespace handhold {
namespace {

constexpr double k_rad_per_px = 0.0025;
constexpr double k_wheel_m = 0.04;  // a notch
constexpr int k_large_px = 1000;    // windows at least so wide have large letters
constexpr SDL_Color k_ink{235, 240, 245, 255};
constexpr SDL_Color k_lit{70, 255, 110, 255};
constexpr SDL_Color k_shade{0, 0, 0, 190};

bool is_down(const Uint8* keys, SDL_Scancode key) { return keys[key] != 0; }
double axis(const Uint8* keys, SDL_Scancode less, SDL_Scancode more) {
    return (is_down(keys, more) ? 1.0 : 0.0) - (is_down(keys, less) ? 1.0 : 0.0);
}

}  // namespace

struct Window::Impl {
    SDL_Window* window = nullptr;
    SDL_Renderer* renderer = nullptr;
    SDL_Texture* texture = nullptr;
    int texture_width = 0;
    int texture_height = 0;
    std::vector<unsigned char> glyphs;  // reused
    std::vector<SDL_Vertex> vertices;
    std::vector<int> indices;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        SDL_DestroyTexture(texture);
        SDL_DestroyRenderer(renderer);
        SDL_DestroyWindow(window);
        SDL_Quit();
    }
    void show_picture(const Image& picture);
    int width_px() const;
    void show_text(std::string_view text, float scale, float x, float y, SDL_Color color);
    void show_mark(bool may_reach) const;
};

void Window::Impl::show_picture(const Image& picture) {
    if (texture == nullptr || texture_width != picture.width_px ||
        texture_height != picture.height_px) {
        SDL_DestroyTexture(texture);
        texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING,
                                    picture.width_px, picture.height_px);
        texture_width = picture.width_px;
        texture_height = picture.height_px;
        SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_NONE);
    }
    if (texture != nullptr) {
        SDL_UpdateTexture(texture, nullptr, picture.rgba.data(), 4 * picture.width_px);
        SDL_RenderCopy(renderer, texture, nullptr, nullptr);
    }
}

int Window::Impl::width_px() const {
    int width = 0;
    SDL_GetRendererOutputSize(renderer, &width, nullptr);
    return width;
}

void Window::Impl::show_text(std::string_view text, float scale, float x, float y,
                             SDL_Color color) {
    constexpr std::size_t k_corner_bytes = 16;  // x, y, z as floats, then a colour
    constexpr std::size_t k_glyph_bytes = 300;  // more than any glyph takes
    glyphs.resize(k_glyph_bytes * (text.size() + 1));
    std::string copy(text);
    const int quads = stb_easy_font_print(0.0F, 0.0F, copy.data(), nullptr, glyphs.data(),
                                          static_cast<int>(glyphs.size()));
    vertices.clear();
    indices.clear();
    for (int quad = 0; quad < quads; ++quad) {
        const auto first = static_cast<int>(vertices.size());
        for (int corner = 0; corner < 4; ++corner) {
            float place[2] = {};
            const std::size_t at = k_corner_bytes * static_cast<std::size_t>(4 * quad + corner);
            std::copy_n(glyphs.data() + at, sizeof place, reinterpret_cast<unsigned char*>(place));
            vertices.push_back({{x + scale * place[0], y + scale * place[1]}, color, {0.0F, 0.0F}});
        }
        indices.insert(indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
    SDL_RenderGeometry(renderer, nullptr, vertices.data(), static_cast<int>(vertices.size()),
                       indices.data(), static_cast<int>(indices.size()));
}

// What he looks at, and so reaches for.
void Window::Impl::show_mark(bool may_reach) const {
    int width = 0;
    int height = 0;
    SDL_GetRendererOutputSize(renderer, &width, &height);
    const int middle_px = may_reach ? 8 : 4;
    for (const auto& [size, color] :
         {std::pair{middle_px + 4, k_shade}, std::pair{middle_px, may_reach ? k_lit : k_ink}}) {
        const SDL_Rect mark{(width - size) / 2, (height - size) / 2, size, size};
        SDL_SetRenderDrawColor(renderer, color.r, color.g, color.b, color.a);
        SDL_RenderFillRect(renderer, &mark);
    }
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
    // Pictures come from a renderer of our own; a second OpenGL context, the window's, would get in
    // its way on this thread.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        return failed();
    }
    // Without a display SDL plays for nobody, unless it is told to.
    const std::string_view driver = SDL_GetCurrentVideoDriver();
    if (SDL_getenv("SDL_VIDEODRIVER") == nullptr && (driver == "offscreen" || driver == "dummy")) {
        why_not = "no display";
        return nullptr;
    }
    impl->window = SDL_CreateWindow(title.c_str(), k_anywhere, k_anywhere, width_px, height_px,
                                    SDL_WINDOW_RESIZABLE);
    if (impl->window == nullptr) {
        return failed();
    }
    impl->renderer = SDL_CreateRenderer(impl->window, -1, SDL_RENDERER_SOFTWARE);
    if (impl->renderer == nullptr) {
        return failed();
    }
    SDL_SetRenderDrawBlendMode(impl->renderer, SDL_BLENDMODE_BLEND);
    SDL_SetRelativeMouseMode(SDL_TRUE);
    return std::unique_ptr<Window>(new Window(std::move(impl)));
}

WindowEvents Window::poll() {
    WindowEvents events;
    DesktopInput& input = events.input;
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0) {
        const bool closes = event.type == SDL_WINDOWEVENT &&
                            event.window.event == SDL_WINDOWEVENT_CLOSE &&
                            event.window.windowID == SDL_GetWindowID(impl_->window);
        if (event.type == SDL_QUIT || closes) {
            events.quit = true;
        } else if (event.type == SDL_KEYDOWN && event.key.repeat == 0) {
            events.quit = events.quit || event.key.keysym.sym == SDLK_ESCAPE;
            events.help = events.help != (event.key.keysym.sym == SDLK_F1);
        } else if (event.type == SDL_MOUSEMOTION) {
            input.turn_left_rad -= k_rad_per_px * event.motion.xrel;
            input.look_up_rad -= k_rad_per_px * event.motion.yrel;
        } else if (event.type == SDL_MOUSEBUTTONUP) {
            input.opened[0] = input.opened[0] || event.button.button == SDL_BUTTON_LEFT;
            input.opened[1] = input.opened[1] || event.button.button == SDL_BUTTON_RIGHT;
        } else if (event.type == SDL_MOUSEWHEEL) {
            input.farther_m += k_wheel_m * event.wheel.y;
        }
    }
    const Uint32 buttons = SDL_GetMouseState(nullptr, nullptr);
    input.grip = {(buttons & SDL_BUTTON_LMASK) != 0, (buttons & SDL_BUTTON_RMASK) != 0};
    const Uint8* const keys = SDL_GetKeyboardState(nullptr);
    input.move = {axis(keys, SDL_SCANCODE_A, SDL_SCANCODE_D),
                  axis(keys, SDL_SCANCODE_Q, SDL_SCANCODE_E),
                  axis(keys, SDL_SCANCODE_W, SDL_SCANCODE_S)};
    input.hurry = is_down(keys, SDL_SCANCODE_LSHIFT) || is_down(keys, SDL_SCANCODE_RSHIFT);
    input.brake = is_down(keys, SDL_SCANCODE_SPACE);
    return events;
}

void Window::show(const Image& picture, bool may_reach, std::string_view text) {
    Impl& impl = *impl_;
    SDL_SetRenderDrawColor(impl.renderer, 0, 0, 0, 255);
    SDL_RenderClear(impl.renderer);
    impl.show_picture(picture);
    impl.show_mark(may_reach);
    constexpr float k_margin_px = 16.0F;
    const float scale = impl.width_px() >= k_large_px ? 2.0F : 1.0F;
    impl.show_text(text, scale, k_margin_px + scale, k_margin_px + scale, k_shade);
    impl.show_text(text, scale, k_margin_px, k_margin_px, k_ink);
    SDL_RenderPresent(impl.renderer);
}

}  // namespace handhold
