#include "game/xr/actions.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace handhold {
namespace {

constexpr std::array<const char*, 2> k_hand_paths = {"/user/hand/left", "/user/hand/right"};
constexpr double k_ns_per_s = 1e9;

XrActionType type_of(ActionKind kind) {
    switch (kind) {
        case ActionKind::pose:
            return XR_ACTION_TYPE_POSE_INPUT;
        case ActionKind::number:
            return XR_ACTION_TYPE_FLOAT_INPUT;
        case ActionKind::button:
            return XR_ACTION_TYPE_BOOLEAN_INPUT;
        case ActionKind::stick:
            return XR_ACTION_TYPE_VECTOR2F_INPUT;
        case ActionKind::shake:
            break;
    }
    return XR_ACTION_TYPE_VIBRATION_OUTPUT;
}

bool concerns(const HeadsetBinding& binding, std::size_t side) {
    using Hands = HeadsetBinding::Hands;
    return binding.hands == Hands::both || (binding.hands == Hands::left) == (side == HH_LEFT);
}

}  // namespace

std::optional<LocatedPose> locate(XrSpace space, XrSpace base, XrTime time) {
    auto location = xr_struct<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    if (XR_FAILED(xrLocateSpace(space, base, time, &location)) ||
        !is_valid_location(location.locationFlags)) {
        return std::nullopt;
    }
    return LocatedPose{from_xr(location.pose), is_inferred_location(location.locationFlags)};
}

std::optional<HeadsetActions> HeadsetActions::create(const HeadsetInstance& instance,
                                                     XrSession session, std::string& why_not) {
    HeadsetActions made;
    const XrInstance xr = instance.instance.get();
    const bool has_palms = instance.features.palm_pose;
    auto info = xr_struct<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
    std::strncpy(info.actionSetName, "hands", XR_MAX_ACTION_SET_NAME_SIZE - 1);
    std::strncpy(info.localizedActionSetName, "Hands", XR_MAX_LOCALIZED_ACTION_SET_NAME_SIZE - 1);
    for (std::size_t side = 0; side < 2; ++side) {
        if (!xr_succeeds(xrStringToPath(xr, k_hand_paths[side], &made.hands_[side]),
                         "xrStringToPath", why_not)) {
            return std::nullopt;
        }
    }
    if (!xr_succeeds(xrCreateActionSet(xr, &info, made.set_.out()), "xrCreateActionSet", why_not) ||
        !made.create_actions(has_palms, why_not) || !made.suggest(xr, has_palms, why_not) ||
        !made.create_spaces(session, why_not)) {
        return std::nullopt;
    }
    auto attach = xr_struct<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
    const XrActionSet set = made.set_.get();
    attach.countActionSets = 1;
    attach.actionSets = &set;
    if (!xr_succeeds(xrAttachSessionActionSets(session, &attach), "xrAttachSessionActionSets",
                     why_not)) {
        return std::nullopt;
    }
    return made;
}

bool HeadsetActions::create_actions(bool has_palms, std::string& why_not) {
    for (const HeadsetActionName& name : k_headset_actions) {
        if (name.action == HeadsetAction::palm_pose && !has_palms) {
            continue;
        }
        auto info = xr_struct<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
        info.actionType = type_of(name.kind);
        std::strncpy(info.actionName, name.name, XR_MAX_ACTION_NAME_SIZE - 1);
        std::strncpy(info.localizedActionName, name.said, XR_MAX_LOCALIZED_ACTION_NAME_SIZE - 1);
        info.countSubactionPaths = 2;
        info.subactionPaths = hands_.data();
        XrAction& made = actions_[static_cast<std::size_t>(name.action)];
        if (!xr_succeeds(xrCreateAction(set_.get(), &info, &made), "xrCreateAction", why_not)) {
            return false;
        }
    }
    return true;
}

// Skips profiles that the runtime does not know; one known profile is enough.
bool HeadsetActions::suggest(XrInstance instance, bool has_palms, std::string& why_not) const {
    bool any = false;
    std::string refusal;  // reason of the last failed profile; reported only if none is known
    for (const HeadsetProfile& profile : headset_profiles()) {
        std::vector<XrActionSuggestedBinding> bindings;
        for (const HeadsetBinding& binding : profile.bindings) {
            for (std::size_t side = 0; side < 2; ++side) {
                if (!concerns(binding, side) ||
                    (binding.action == HeadsetAction::palm_pose && !has_palms)) {
                    continue;
                }
                const std::string path = std::string(k_hand_paths[side]) + binding.path;
                XrActionSuggestedBinding suggested{action(binding.action), XR_NULL_PATH};
                if (XR_SUCCEEDED(xrStringToPath(instance, path.c_str(), &suggested.binding))) {
                    bindings.push_back(suggested);
                }
            }
        }
        auto info = xr_struct<XrInteractionProfileSuggestedBinding>(
            XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
        info.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
        info.suggestedBindings = bindings.data();
        any = (xr_succeeds(xrStringToPath(instance, profile.path, &info.interactionProfile),
                           "xrStringToPath", refusal) &&
               xr_succeeds(xrSuggestInteractionProfileBindings(instance, &info),
                           "xrSuggestInteractionProfileBindings", refusal)) ||
              any;
    }
    if (!any) {
        why_not = refusal;
    }
    return any;
}

bool HeadsetActions::create_spaces(XrSession session, std::string& why_not) {
    for (std::size_t pose = 0; pose < spaces_.size(); ++pose) {
        for (std::size_t side = 0; side < 2; ++side) {
            auto info = xr_struct<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
            info.action = actions_[pose];
            info.subactionPath = hands_[side];
            info.poseInActionSpace = k_xr_identity;
            if (info.action != XR_NULL_HANDLE &&
                !xr_succeeds(xrCreateActionSpace(session, &info, spaces_[pose][side].out()),
                             "xrCreateActionSpace", why_not)) {
                return false;
            }
        }
    }
    return true;
}

XrResult HeadsetActions::sync(XrSession session) {
    const XrActiveActionSet active{set_.get(), XR_NULL_PATH};
    auto info = xr_struct<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
    info.countActiveActionSets = 1;
    info.activeActionSets = &active;
    return xrSyncActions(session, &info);
}

namespace {

template <class State>
State state_of(XrResult (*get)(XrSession, const XrActionStateGetInfo*, State*), XrSession session,
               XrAction action, XrPath hand, XrStructureType type) {
    auto info = xr_struct<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    info.action = action;
    info.subactionPath = hand;
    auto state = xr_struct<State>(type);
    if (XR_FAILED(get(session, &info, &state))) {
        state.isActive = XR_FALSE;
    }
    return state;
}

}  // namespace

double HeadsetActions::number(XrSession session, HeadsetAction which, std::size_t side) const {
    const auto state = state_of<XrActionStateFloat>(&xrGetActionStateFloat, session, action(which),
                                                    hands_[side], XR_TYPE_ACTION_STATE_FLOAT);
    return state.isActive == XR_TRUE ? std::clamp(static_cast<double>(state.currentState), 0.0, 1.0)
                                     : 0.0;
}

bool HeadsetActions::button(XrSession session, HeadsetAction which, std::size_t side) const {
    const auto state =
        state_of<XrActionStateBoolean>(&xrGetActionStateBoolean, session, action(which),
                                       hands_[side], XR_TYPE_ACTION_STATE_BOOLEAN);
    return state.isActive == XR_TRUE && state.currentState == XR_TRUE;
}

std::array<double, 2> HeadsetActions::stick(XrSession session, std::size_t side) const {
    const auto state = state_of<XrActionStateVector2f>(&xrGetActionStateVector2f, session,
                                                       action(HeadsetAction::stick), hands_[side],
                                                       XR_TYPE_ACTION_STATE_VECTOR2F);
    if (state.isActive != XR_TRUE) {
        return {};
    }
    return {static_cast<double>(state.currentState.x), static_cast<double>(state.currentState.y)};
}

bool HeadsetActions::is_active(XrSession session, HeadsetAction which, std::size_t side) const {
    return state_of<XrActionStatePose>(&xrGetActionStatePose, session, action(which), hands_[side],
                                       XR_TYPE_ACTION_STATE_POSE)
               .isActive == XR_TRUE;
}

std::optional<LocatedPose> HeadsetActions::pose(XrSession session, HeadsetAction which,
                                                std::size_t side, XrSpace base, XrTime time) const {
    const OwnedXrSpace& space = spaces_[static_cast<std::size_t>(which)][side];
    if (!space || !is_active(session, which, side)) {
        return std::nullopt;
    }
    return locate(space.get(), base, time);
}

void HeadsetActions::read(XrSession session, XrSpace base, XrTime time,
                          std::array<HandReading, 2>& hands) const {
    for (std::size_t side = 0; side < 2; ++side) {
        HandReading& hand = hands[side];
        // The pose, and the guess: at most one of them is known.
        const auto read_pose = [&](HeadsetAction which, std::optional<hh::Pose>& measured,
                                   std::optional<hh::Pose>& guess) {
            const std::optional<LocatedPose> found = pose(session, which, side, base, time);
            measured.reset();
            guess.reset();
            if (found) {
                (found->is_inferred ? guess : measured) = found->pose;
            }
        };
        std::optional<hh::Pose> aim_guess;  // unused
        read_pose(HeadsetAction::grip_pose, hand.grip_ps, hand.guesses.grip_ps);
        read_pose(HeadsetAction::aim_pose, hand.aim_ps, aim_guess);
        read_pose(HeadsetAction::palm_pose, hand.palm_ps, hand.guesses.palm_ps);
        hand.squeeze = number(session, HeadsetAction::squeeze, side);
        hand.trigger = number(session, HeadsetAction::trigger, side);
        hand.stick = stick(session, side);
        hand.brake = button(session, HeadsetAction::brake, side);
        hand.calibrate = button(session, HeadsetAction::calibrate, side);
    }
}

void HeadsetActions::shake(XrSession session, hh::Side side, const HapticPulse& pulse) const {
    auto info = xr_struct<XrHapticActionInfo>(XR_TYPE_HAPTIC_ACTION_INFO);
    info.action = action(HeadsetAction::shake);
    info.subactionPath = hands_[side];
    auto vibration = xr_struct<XrHapticVibration>(XR_TYPE_HAPTIC_VIBRATION);
    vibration.amplitude = static_cast<float>(pulse.amplitude);
    vibration.duration = static_cast<XrDuration>(pulse.duration_s * k_ns_per_s);
    vibration.frequency = XR_FREQUENCY_UNSPECIFIED;
    // An error is ignored: not every controller can vibrate.
    static_cast<void>(xrApplyHapticFeedback(
        session, &info,
        reinterpret_cast<const XrHapticBaseHeader*>(&vibration)));  // NOLINT: OpenXR API
}

}  // namespace handhold
