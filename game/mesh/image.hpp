#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace handhold {

// A picture: rows from the top, four bytes per pixel (sRGB red, green, blue, then alpha), no
// padding.
struct Image {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::uint8_t> rgba;  // 4 * width_px * height_px bytes

    // First of the pixel's four bytes. Precondition: 0 <= x < width_px, 0 <= y < height_px.
    const std::uint8_t* pixel(int x, int y) const;
};

// The picture as a PNG file in memory; empty for an empty picture.
std::vector<std::uint8_t> encode_png(const Image& image);
// Decodes a PNG file; nullopt if the bytes are no PNG file.
std::optional<Image> decode_png(std::span<const std::uint8_t> bytes);
// Writes a PNG with write_file_atomically. Fails for an empty picture.
[[nodiscard]] std::optional<FileError> save_png(const Image& image, const std::string& path);
// Base64 (RFC 4648) with padding, for pictures inside an HTML page.
std::string encode_base64(std::span<const std::uint8_t> bytes);

}  // namespace handhold
