#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "game/headset/headset_reading.hpp"
#include "game/render/gl_context.hpp"
#include "game/render/render_frame.hpp"

namespace handhold {

inline constexpr std::size_t k_eye_count = 2;

struct EyeSize {
    int width_px = 0;
    int height_px = 0;
};

// Of one eye's picture: what the runtime recommends, and the largest that it takes.
struct EyeSizes {
    EyeSize recommended;
    EyeSize largest;
};

// One eye's picture to be drawn: OpenGL's name of a texture of the runtime, rows from the bottom,
// bytes in sRGB.
struct EyePicture {
    std::size_t eye = 0;  // 0 left, 1 right
    Pose eye_ps;          // in the space of the readings
    EyeFrustum frustum;
    std::uint32_t texture = 0;
    EyeSize size;
};
using DrawEye = std::function<void(const EyePicture&)>;

// What became of the session since it was last asked.
enum class HeadsetState : std::uint8_t {
    waits,  // the runtime does not want frames yet, or no longer: ask again
    runs,
    lost,   // for good: a new Headset may find the runtime again
    leaves  // whoever wears it wants to leave
};

// The frame that the runtime waits for next.
struct HeadsetFrame {
    std::int64_t display_ns = 0;  // when it will be seen, on the runtime's clock
    std::int64_t period_ns = 0;   // from one refresh of the display to the next
    bool is_seen = false;         // else: no picture is wanted
};

// A headset with its controllers, through the machine's OpenXR runtime: a session from its
// beginning until it is lost or left. Nothing here throws; once the runtime is gone, state() says
// so. OpenXR is named in game/xr/ only. Built without OpenXR, open() says that.
class Headset {
  public:
    // Nothing, with the reason in one line, where there is no runtime or no headset. headless: no
    // pictures and no graphics card, poses and buttons only (XR_MND_headless).
    static std::unique_ptr<Headset> open(bool headless, std::string& why_not);
    ~Headset();
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;

    // Zero where it is headless, or the runtime does not say.
    EyeSizes eye_sizes() const;
    // "Monado 25.0.0, Monado: Remote HMD"
    const std::string& description() const;

    // Creates the session; pictures of that size. `gl` must be current and outlive this; null where
    // it is headless. False, with the reason, where the runtime refuses.
    bool begin(const GlContext* gl, const EyeSize& size, std::string& why_not);
    // Reads the runtime's events and obeys: begins, ends, finds out that all is lost.
    HeadsetState poll();
    // Buttons and poses reach the game only then.
    bool has_focus() const;
    // Waits until it is time for the next frame; then end_frame() must follow. Precondition:
    // poll() said runs.
    HeadsetFrame begin_frame();
    // Asks for the controllers' state, once a frame; read() then gives it with the poses of any
    // time around now.
    void sync();
    HeadsetReading read(std::int64_t time_ns) const;
    // Pictures are drawn where they are wanted. True where both eyes were shown one.
    bool end_frame(const HeadsetFrame& frame, const DrawEye& draw_eye);
    // True where the controller was told to.
    bool shake(HandSide side, const HapticPulse& pulse) const;
    // Asks the runtime to end the session; poll() says leaves when it has.
    void ask_to_leave();

  private:
    struct Impl;
    explicit Headset(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
