#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace handhold::lab {

// `handhold-lab match-film`: two recorded sessions play a match over a simulated network. Draws the
// second player at the same ticks as their own machine shows them and as the first player's does:
// between two ticks, as the game does (hh_match_drawn_player).
struct MatchFilmOptions {
    std::string scene = "playground";
    std::vector<std::string> inputs;  // two recorded sessions (.csv)
    double rtt_ms = 150.0;            // round trip without jitter
    double jitter_ms = 20.0;          // largest extra delay, in each direction
    double loss = 0.05;               // share of packets, in each direction
    double from_s = 3.0;              // first picture, in the match's time
    double seconds = 10.0;            // length of the film
    int ticks_a_picture = 3;
    bool hides_corrections = true;  // false: draws as stepped, not between ticks
    // Camera: metres to the right of, above and before the second player's first place; it looks at
    // `height_m` above that place.
    std::array<double, 3> from_m = {0.9, 1.6, 1.9};
    double height_m = 1.15;
    double fov_deg = 50.0;
    int width_px = 480;
    int height_px = 400;
    std::uint64_t seed = 1;
    std::filesystem::path out;  // an existing folder: there_TICK.png and here_TICK.png
};

// Prints the number of pictures, rollbacks and grips, and how far apart the second player's hands
// are on both machines: stepped hands with their shown offsets, at the same tick. Exit status: 0; 2
// with one line on standard error if a file is invalid or cannot be written, or if nothing can be
// drawn; 3 if no picture shows anything after a rollback.
int match_film_command(const MatchFilmOptions& options);

}  // namespace handhold::lab
