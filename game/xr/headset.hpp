#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "game/devices/headset_reading.hpp"
#include "game/mesh/render_frame.hpp"
#include "game/render/gl_context.hpp"

namespace handhold {

inline constexpr std::size_t k_eye_count = 2;

struct EyeSize {
    int width_px = 0;
    int height_px = 0;
};

// Sizes of one eye's picture: recommended by the runtime, and the largest that it accepts.
struct EyeSizes {
    EyeSize recommended;
    EyeSize largest;
};

// A picture to be drawn for one eye. `texture`: OpenGL name of a texture of the runtime; rows from
// the bottom up, bytes in sRGB.
struct EyePicture {
    std::size_t eye = 0;             // 0 left, 1 right
    hh::Pose eye_ps = hh::k_origin;  // eye in play space
    EyeFrustum frustum;
    std::uint32_t texture = 0;
    EyeSize size;
};
using DrawEye = std::function<void(const EyePicture&)>;

// State of the session, as poll() reports it.
enum class HeadsetState : std::uint8_t {
    waits,  // the runtime wants no frames now; poll again
    runs,
    lost,   // session is over for good; a new Headset may find the runtime again
    leaves  // the session is over: the player or the program asked to leave
};

// The next frame for the runtime.
struct HeadsetFrame {
    std::int64_t display_ns = 0;  // time of its display, on the runtime's clock
    std::int64_t period_ns = 0;   // interval between refreshes of the display
    bool is_seen = false;         // false: the runtime wants no picture
};

// A headset with its controllers, accessed through OpenXR: one session, from its beginning until it
// is lost or left. Throws nothing; once the runtime is lost, poll() returns HeadsetState::lost.
// Only game/xr/ uses OpenXR. In builds without OpenXR, open() fails and says so.
class Headset {
  public:
    // Returns nullptr, with a reason of one line, if there is no runtime or no headset. headless:
    // poses and buttons only, without pictures and graphics card (XR_MND_headless).
    static std::unique_ptr<Headset> open(bool headless, std::string& why_not);
    ~Headset();
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;

    // 0 if headless, or if the runtime does not say.
    EyeSizes eye_sizes() const;
    // Runtime and headset: "Monado 25.0.0, Monado: Remote HMD". After begin() also the tracking
    // space.
    const std::string& description() const;

    // Creates the session, with pictures of this size. `gl` must be current and outlive this
    // object; null if headless. Returns false, with the reason, if the runtime refuses.
    bool begin(const GlContext* gl, const EyeSize& size, std::string& why_not);
    // Handles the runtime's pending events: begins or ends the session when the runtime asks for
    // it, and notices when the session or the runtime is lost.
    HeadsetState poll();
    // True if the session has focus; otherwise hands read as not tracked.
    bool has_focus() const;
    // Waits until it is time for the next frame. display_ns is 0 if the runtime was lost; otherwise
    // end_frame() must follow. Precondition: the last poll() returned `runs`.
    HeadsetFrame begin_frame();
    // sync() updates the state of the controllers; call it once per frame. read() returns that
    // state, with poses predicted for time_ns.
    void sync();
    HeadsetReading read(std::int64_t time_ns) const;
    // Draws both eyes if frame.is_seen, and hands the frame to the runtime. Returns true if both
    // eyes got a picture.
    bool end_frame(const HeadsetFrame& frame, const DrawEye& draw_eye);
    // Returns true if the controller was told to vibrate.
    bool shake(hh::Side side, const HapticPulse& pulse) const;
    // Asks the runtime to end the session; poll() returns `leaves` once it has.
    void ask_to_leave();

  private:
    struct Impl;
    explicit Headset(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace handhold
