#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace handhold::lab {

// `handhold-lab hands-picture`: posed hands on a mesh as they stand in a G.jsonl, each from where
// it is seen best, as one sheet.
struct HandsPictureOptions {
    std::filesystem::path mesh;
    std::filesystem::path hands;  // G.jsonl
    std::filesystem::path out;    // PNG
    std::string style = "capsules";
    std::vector<std::int64_t> ids;  // empty: `count` hands spread evenly over the file
    int count = 12;
    int columns = 4;
    int width_px = 480;  // of one picture
    int height_px = 400;
};

// Exit status: 0; 2 for a file that breaks its format or cannot be written, or where nothing can be
// drawn. One line on standard error says why; on standard output the ids, row by row.
int hands_picture_command(const HandsPictureOptions& options);

}  // namespace handhold::lab
