#include "systems/hand/shared/hand_unknowns.hpp"

namespace handhold {

HandUnknowns::HandUnknowns(const HandRig& rig) : rig_(rig) {
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        first_[f] = static_cast<int>(count_);
        count_ += finger.link_count;
        opposition_[f] = -1;
        if (finger.lower_opposition_rad < finger.upper_opposition_rad) {
            opposition_[f] = static_cast<int>(count_++);
        }
    }
}

Unknowns HandUnknowns::bend(std::size_t finger, double sign) const {
    Unknowns slope = Unknowns::Zero();
    for (std::size_t i = 0; i < rig_.fingers[finger].link_count; ++i) {
        slope[hinge(finger, i)] = sign;
    }
    return slope;
}

Unknowns HandUnknowns::direction(std::size_t finger, double sign) const {
    const FingerRig& rig = rig_.fingers[finger];
    double whole_m = 0.0;
    for (std::size_t i = 0; i < rig.link_count; ++i) {
        whole_m += rig.length_m[i];
    }
    Unknowns slope = Unknowns::Zero();
    double beyond_m = whole_m;
    for (std::size_t i = 0; i < rig.link_count; ++i) {
        slope[hinge(finger, i)] = sign * beyond_m / whole_m;
        beyond_m -= rig.length_m[i];
    }
    return slope;
}

Unknowns unit(int place, double value) {
    Unknowns slope = Unknowns::Zero();
    slope[place] = value;
    return slope;
}

}  // namespace handhold
