#pragma once

#include <optional>
#include <string_view>

#include "systems/rigs/hand_joint_names.hpp"

// Guesses the finger and the place in the finger from a joint's name.
namespace handhold {

struct FingerJointGuess {
    FingerName finger = FingerName::index;
    // The bone that the name says; none: the name only counts, or says nothing.
    std::optional<HandBone> bone;
    // The joint's number along the finger, from 0 or 1; none: the name has no number.
    std::optional<int> number;
};

// Guesses the finger from the words of a joint's name. For example, "mixamorig:LeftHandIndex1",
// "index_01_l", "Left Index Proximal", "b_l_index1", "lIndex1", "DEF-f_index.01.L", "finger2-1.L",
// "Bip01 L Finger1" and "左人指１" are the first joints of an index finger. Ignores case,
// separators and namespaces. Returns none for helpers, controls, and names of no finger.
std::optional<FingerJointGuess> parse_finger_joint_name(std::string_view name);

}  // namespace handhold
