#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace handhold::lab {

// `handhold-lab hands-picture`: draws hands that `handhold-lab grip` has posed on a mesh, each from
// its best viewpoint, as one sheet.
struct HandsPictureOptions {
    std::filesystem::path mesh;
    std::filesystem::path hands;     // output of `handhold-lab grip` (JSON lines)
    std::filesystem::path out;       // PNG
    std::string style = "capsules";  // or "skin": the game's hand
    std::string hand = "right";      // side of the game's hand
    int views = 1;                   // views of each hand, side by side: 1 or 2
    std::vector<std::int64_t> ids;   // empty: `count` hands spread evenly over the file
    int count = 12;
    int columns = 4;
    int width_px = 480;  // size of one picture
    int height_px = 400;
};

// Exit status: 0, or 2 with one line on standard error if a file is invalid or cannot be written,
// or if nothing can be drawn. Prints the ids to standard output, one line for each row of the
// picture.
int hands_picture_command(const HandsPictureOptions& options);

}  // namespace handhold::lab
