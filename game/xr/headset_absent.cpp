// Replaces headset.cpp in builds without OpenXR.
#include "game/xr/headset.hpp"

namespace handhold {

struct Headset::Impl {
    std::string description;
};

Headset::Headset(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Headset::~Headset() = default;

std::unique_ptr<Headset> Headset::open(bool, std::string& why_not) {
    why_not = "no OpenXR: this program was built without it";
    return nullptr;
}

EyeSizes Headset::eye_sizes() const { return {}; }
const std::string& Headset::description() const { return impl_->description; }
bool Headset::begin(const GlContext*, const EyeSize&, std::string&) { return false; }
HeadsetState Headset::poll() { return HeadsetState::lost; }
bool Headset::has_focus() const { return false; }
HeadsetFrame Headset::begin_frame() { return {}; }
void Headset::sync() {}
HeadsetReading Headset::read(std::int64_t) const { return {}; }
bool Headset::end_frame(const HeadsetFrame&, const DrawEye&) { return false; }
bool Headset::shake(hh::Side, const HapticPulse&) const { return false; }
void Headset::ask_to_leave() {}

}  // namespace handhold
