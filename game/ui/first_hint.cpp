#include "game/ui/first_hint.hpp"

namespace handhold {
namespace {

constexpr double k_pulled_m = 0.3;  // pulling so far means that it is understood
constexpr double k_again_s = 6.0;   // how long the last line is shown

}  // namespace

void FirstHint::advance(const Seen& seen, double dt_s) {
    if (step_ == Step::again) {
        again_s_ += dt_s;
        step_ = again_s_ < k_again_s ? Step::again : Step::gone;
        return;
    }
    if (step_ == Step::gone) {
        return;
    }
    pulled_m_ = seen.grips ? pulled_m_ + seen.moved_m : 0.0;
    step_ = pulled_m_ > k_pulled_m ? Step::again
            : seen.grips           ? Step::pull
            : seen.can_reach       ? Step::press
                                   : Step::look;
}

const char* FirstHint::text() const {
    switch (step_) {
        case Step::look:
            return "Look at something near with the mouse: the mark turns green where a hand can "
                   "reach";
        case Step::press:
            return "Hold the left or the right mouse button: that hand grips at the ring";
        case Step::pull:
            return "Hold on, and pull yourself along: W A S D, Q E";
        case Step::again:
            return "Let go to float, grip again to stop. F1 shows all keys";
        case Step::gone:
            break;
    }
    return "";
}

}  // namespace handhold
