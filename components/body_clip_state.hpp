#pragma once

namespace handhold {

// Where a player's clips are. Written by layer_additives.
struct BodyClipState {
    bool gripping = false;      // anything that he could push himself off
    bool was_gripping = false;  // a frame before
    double idle_s = 0.0;        // [0, the clip's length]
    // Since he let go, up to the clip's length: until it is over none begins anew.
    double push_off_s = 0.0;
    double push_off_weight = 0.0;  // [0, 1], by the speed he left with; 0: never did
};

}  // namespace handhold
