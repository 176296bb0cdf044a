#pragma once

namespace handhold {

// How much a row may give way, relative to the system's diagonal; joints and limits hardly do.
struct Softness {
    double hand = 1e-6;
    double contact = 1e-7;
    double joint = 1e-10;
};

// How hands and contacts soften and harden from step to step, and how far a step may go.
struct StepSchedule {
    double softest_hand = 1e-2;
    double hardest_hand = 1e-9;
    double softest_contact = 1e-3;  // of those that contradict each other
    double hardening = 0.03;        // times a hand's softness, where the error falls
    double softening = 10.0;        // times it, where the error does not
    int steady_steps = 3;           // whole steps in a row that each leave less than
    double steady_share = 0.95;     // this share of the error let it fall as well
    double largest_turn_rad = 1.0;  // of a step; it is scaled down to it
    double least_scale = 0.3;       // a step scaled down further is tried again, with softer rows
};

}  // namespace handhold
