#pragma once

namespace handhold {

// How much a row may give way, relative to the system's diagonal; joints and limits hardly do.
struct Softness {
    double hand = 1e-6;
    double contact = 1e-7;
    double joint = 1e-10;
};

}  // namespace handhold
