#include "game/xr/headset.hpp"

#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "game/devices/play_space_changes.hpp"
#include "game/xr/actions.hpp"
#include "game/xr/eyes.hpp"
#include "game/xr/finger_tracking.hpp"
#include "game/xr/instance.hpp"
#include "game/xr/session_phase.hpp"
#include "game/xr/spaces.hpp"

namespace handhold {
namespace {

// 90 Hz; arbitrary, because nothing is displayed
constexpr std::int64_t k_headless_period_ns = 11'111'111;
constexpr auto k_wait_between_polls = std::chrono::milliseconds(5);

SessionState state_from(XrSessionState state) {
    return state >= XR_SESSION_STATE_IDLE && state <= XR_SESSION_STATE_EXITING
               ? static_cast<SessionState>(state)
               : SessionState::unknown;
}

std::optional<OwnedXrSession> create_session(const HeadsetInstance& instance, const GlContext* gl,
                                             std::string& why_not) {
    auto info = xr_struct<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
    info.systemId = instance.system;
    auto binding = xr_struct<XrGraphicsBindingEGLMNDX>(XR_TYPE_GRAPHICS_BINDING_EGL_MNDX);
    if (gl != nullptr) {
        const auto requirements = xr_function<PFN_xrGetOpenGLGraphicsRequirementsKHR>(
            instance.instance.get(), "xrGetOpenGLGraphicsRequirementsKHR");
        auto versions =
            xr_struct<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
        if (requirements == nullptr || gl->api() != GlApi::desktop_33) {
            why_not = "the headset needs desktop OpenGL";
            return std::nullopt;
        }
        if (!xr_succeeds(requirements(instance.instance.get(), instance.system, &versions),
                         "xrGetOpenGLGraphicsRequirementsKHR", why_not)) {
            return std::nullopt;
        }
        const GlContext::Handles handles = gl->handles();
        binding.getProcAddress = handles.get_proc_address;
        binding.display = handles.display;
        binding.config = handles.config;
        binding.context = handles.context;
        info.next = &binding;
    }
    OwnedXrSession session;
    if (!xr_succeeds(xrCreateSession(instance.instance.get(), &info, session.out()),
                     "xrCreateSession", why_not)) {
        return std::nullopt;
    }
    return session;
}

// The runtime's preferred blend mode. See-through headsets have no opaque one.
XrEnvironmentBlendMode first_blend_mode(const HeadsetInstance& instance) {
    XrEnvironmentBlendMode first = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    std::uint32_t count = 0;
    const auto enumerate = [&](std::uint32_t room, XrEnvironmentBlendMode* modes) {
        return xrEnumerateEnvironmentBlendModes(instance.instance.get(), instance.system,
                                                XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, room,
                                                &count, modes);
    };
    if (XR_SUCCEEDED(enumerate(0, nullptr)) && count > 0) {
        std::vector<XrEnvironmentBlendMode> modes(count, first);
        if (XR_SUCCEEDED(enumerate(count, modes.data()))) {
            first = modes.front();
        }
    }
    return first;
}

void correct(const hh::Pose& space, HeadsetReading& reading) {
    const auto correct_pose = [&space](std::optional<hh::Pose>& pose) {
        if (pose) {
            *pose = space * *pose;
        }
    };
    correct_pose(reading.head_ps);
    for (HandReading& hand : reading.hands) {
        correct_pose(hand.grip_ps);
        correct_pose(hand.aim_ps);
        correct_pose(hand.palm_ps);
        correct_pose(hand.wrist_ps);
        correct_pose(hand.guesses.grip_ps);
        correct_pose(hand.guesses.palm_ps);
        correct_pose(hand.guesses.wrist_ps);
    }
}

}  // namespace

struct Headset::Impl {
    // The order matters: objects are destroyed before those that they were made from.
    HeadsetInstance instance;
    OwnedXrSession session;
    HeadsetSpaces spaces;
    PlaySpaceChanges changes;
    std::optional<HeadsetActions> actions;
    FingerTracking fingers;
    std::optional<Eyes> eyes;

    bool headless = false;
    std::string description;
    SessionState state = SessionState::unknown;
    bool runs = false;  // true between xrBeginSession and xrEndSession
    bool lost = false;
    bool leaves = false;
    bool has_focus = false;
    std::int64_t last_ns = 0;  // headless: time of the last frame
    XrEnvironmentBlendMode blend_mode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    PFN_xrConvertTimespecTimeToTimeKHR to_time = nullptr;

    // Returns true if the call succeeded. Sets `lost` if the result says that the runtime is gone.
    bool obeys(XrResult result) {
        lost = lost || result == XR_ERROR_INSTANCE_LOST || result == XR_ERROR_SESSION_LOST ||
               result == XR_ERROR_RUNTIME_FAILURE;
        return XR_SUCCEEDED(result);
    }
    void enter(SessionState next);
    void take(const XrEventDataBuffer& event);
    std::int64_t now_ns();
    HeadsetFrame begin_headless_frame();
};

void Headset::Impl::enter(SessionState next) {
    state = next;
    switch (deed_on(next)) {
        case SessionDeed::begin: {
            auto info = xr_struct<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
            info.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
            runs = obeys(xrBeginSession(session.get(), &info));
            lost = lost || !runs;  // otherwise poll() would wait for ever
            break;
        }
        case SessionDeed::end:
            runs = false;
            obeys(xrEndSession(session.get()));
            break;
        case SessionDeed::reopen:
            lost = true;
            break;
        case SessionDeed::leave:
            leaves = true;
            break;
        case SessionDeed::none:
            break;
    }
}

void Headset::Impl::take(const XrEventDataBuffer& event) {
    if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
        // NOLINTNEXTLINE: how OpenXR hands events out
        const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
        if (changed.session == session.get()) {
            enter(state_from(changed.state));
        }
    } else if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
        // NOLINTNEXTLINE: how OpenXR hands events out
        const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
        if (change.session == session.get() && change.referenceSpaceType == spaces.room_type &&
            change.poseValid == XR_TRUE) {
            changes.add(change.changeTime, from_xr(change.poseInPreviousSpace));
        }
    } else if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
        lost = true;
    }
}

std::int64_t Headset::Impl::now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    XrTime time = 0;
    return obeys(to_time(instance.instance.get(), &now, &time)) ? time : last_ns;
}

HeadsetFrame Headset::Impl::begin_headless_frame() {
    const std::int64_t now = now_ns();
    std::int64_t next = last_ns + k_headless_period_ns;
    if (last_ns == 0 || next < now) {  // late: the next frame is due at once
        const std::int64_t late = last_ns == 0 ? 0 : (now - next) / k_headless_period_ns;
        next = last_ns == 0 ? now : next + late * k_headless_period_ns;
    }
    if (next > now) {
        std::this_thread::sleep_for(std::chrono::nanoseconds(next - now));
    }
    last_ns = next;
    return {next, k_headless_period_ns, false};
}

Headset::Headset(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Headset::~Headset() = default;

std::unique_ptr<Headset> Headset::open(bool headless, std::string& why_not) {
    auto instance = open_headset_instance(headless, why_not);
    if (!instance) {
        return nullptr;
    }
    auto impl = std::make_unique<Impl>();
    impl->instance = std::move(*instance);
    impl->headless = headless;
    impl->description = impl->instance.runtime_name + ", " + impl->instance.system_name;
    return std::unique_ptr<Headset>(new Headset(std::move(impl)));
}

EyeSizes Headset::eye_sizes() const {
    return impl_->headless ? EyeSizes{} : eye_sizes_of(impl_->instance);
}

const std::string& Headset::description() const { return impl_->description; }

bool Headset::begin(const GlContext* gl, const EyeSize& size, std::string& why_not) {
    Impl& impl = *impl_;
    auto session = create_session(impl.instance, gl, why_not);
    if (!session) {
        return false;
    }
    impl.session = std::move(*session);
    auto spaces = make_headset_spaces(impl.instance, impl.session.get(), why_not);
    if (!spaces) {
        return false;
    }
    impl.spaces = std::move(*spaces);
    impl.description += ", " + impl.spaces.room_name;
    auto actions = HeadsetActions::create(impl.instance, impl.session.get(), why_not);
    if (!actions) {
        return false;
    }
    impl.actions.emplace(std::move(*actions));
    impl.fingers = FingerTracking::create(impl.instance, impl.session.get());
    if (impl.headless) {
        impl.to_time = xr_function<PFN_xrConvertTimespecTimeToTimeKHR>(
            impl.instance.instance.get(), "xrConvertTimespecTimeToTimeKHR");
        why_not = "the OpenXR runtime does not tell its time";
        return impl.to_time != nullptr;
    }
    impl.blend_mode = first_blend_mode(impl.instance);
    auto eyes = Eyes::create(impl.session.get(), size, why_not);
    if (!eyes) {
        return false;
    }
    impl.eyes.emplace(std::move(*eyes));
    return true;
}

HeadsetState Headset::poll() {
    Impl& impl = *impl_;
    while (!impl.lost) {
        auto event = xr_struct<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
        const XrResult result = xrPollEvent(impl.instance.instance.get(), &event);
        if (!impl.obeys(result) || result == XR_EVENT_UNAVAILABLE) {
            break;
        }
        impl.take(event);
    }
    if (impl.lost) {
        return HeadsetState::lost;
    }
    if (impl.leaves) {
        return HeadsetState::leaves;
    }
    if (!impl.runs) {
        std::this_thread::sleep_for(k_wait_between_polls);
        return HeadsetState::waits;
    }
    return HeadsetState::runs;
}

bool Headset::has_focus() const { return impl_->has_focus; }

HeadsetFrame Headset::begin_frame() {
    Impl& impl = *impl_;
    if (impl.headless) {
        return impl.begin_headless_frame();
    }
    auto state = xr_struct<XrFrameState>(XR_TYPE_FRAME_STATE);
    if (!impl.obeys(xrWaitFrame(impl.session.get(), nullptr, &state)) ||
        !impl.obeys(xrBeginFrame(impl.session.get(), nullptr))) {
        impl.lost = true;  // whatever the result says: the session is useless without frames
        return {};
    }
    return {state.predictedDisplayTime, state.predictedDisplayPeriod,
            state.shouldRender == XR_TRUE};
}

void Headset::sync() {
    Impl& impl = *impl_;
    const XrResult result = impl.actions->sync(impl.session.get());
    impl.has_focus = impl.obeys(result) && result != XR_SESSION_NOT_FOCUSED;
}

HeadsetReading Headset::read(std::int64_t time_ns) const {
    const Impl& impl = *impl_;
    HeadsetReading reading;
    const XrSpace room = impl.spaces.room.get();
    if (const auto head = locate(impl.spaces.head.get(), room, time_ns)) {
        reading.head_ps = head->pose;
        reading.is_head_inferred = head->is_inferred;
    }
    if (impl.has_focus) {
        impl.actions->read(impl.session.get(), room, time_ns, reading.hands);
        impl.fingers.read(room, time_ns, reading.hands);
    }
    correct(impl.changes.space_at(time_ns), reading);
    return reading;
}

bool Headset::end_frame(const HeadsetFrame& frame, const DrawEye& draw_eye) {
    Impl& impl = *impl_;
    if (impl.headless) {
        return false;
    }
    auto info = xr_struct<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
    info.displayTime = frame.display_ns;
    info.environmentBlendMode = impl.blend_mode;
    const XrCompositionLayerBaseHeader* layer = nullptr;
    if (frame.is_seen &&
        impl.eyes->draw(impl.session.get(),
                        {impl.spaces.room.get(), impl.changes.space_at(frame.display_ns)},
                        frame.display_ns, draw_eye)) {
        layer = impl.eyes->layer();
        info.layerCount = 1;
        info.layers = &layer;
    }
    return impl.obeys(xrEndFrame(impl.session.get(), &info)) && layer != nullptr;
}

bool Headset::shake(hh::Side side, const HapticPulse& pulse) const {
    const bool does = impl_->has_focus && pulse.duration_s > 0.0;
    if (does) {
        impl_->actions->shake(impl_->session.get(), side, pulse);
    }
    return does;
}

void Headset::ask_to_leave() {
    if (impl_->runs && !impl_->obeys(xrRequestExitSession(impl_->session.get()))) {
        impl_->leaves = true;
    }
}

}  // namespace handhold
