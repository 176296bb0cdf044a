#pragma once

namespace handhold {

// Playback state of a player's clips. Written by layer_additives.
struct BodyClipState {
    bool gripping = false;      // a hand grips something that the player can push off from
    bool was_gripping = false;  // `gripping` of the last frame
    double idle_s = 0.0;        // time in the idle clip; [0, the clip's length]
    // Time in the push-off clip, which starts when the last hand lets go; at most the clip's
    // length. A new push-off starts only after the clip has ended.
    double push_off_s = 0.0;
    double push_off_weight = 0.0;  // [0, 1], from the speed at release; 0: no push-off yet
    double outside = 1.0;  // [0, 1]: factor on the clips' turns that keeps the body out of surfaces
};

}  // namespace handhold
