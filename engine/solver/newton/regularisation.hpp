#pragma once

namespace handhold {

// How much a row may give way, relative to the system's diagonal; joints and limits hardly do.
struct Regularisation {
    double drive = 1e-6;
    double contact = 1e-7;
    double joint = 1e-10;
};

// How hands and contacts soften and harden from step to step, and how far a step may go.
struct StepControl {
    double max_drive_regularisation = 1e-2;
    double min_drive_regularisation = 1e-9;
    double max_contact_regularisation = 1e-3;  // of those that contradict each other
    double regularisation_decrease = 0.03;  // times a hand's regularisation, where the error falls
    double regularisation_increase = 10.0;  // times it, where the error does not
    int linear_decrease_steps = 3;          // whole steps in a row that each leave less than
    double linear_decrease_ratio = 0.95;    // this share of the error let it fall as well
    double max_step_rotation_rad = 1.0;     // of a step; it is scaled down to it
    double min_step_scale = 0.3;  // a step scaled down further is tried again, with softer rows
};

}  // namespace handhold
