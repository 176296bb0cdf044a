#include "game/mesh/image.hpp"

#include <cstddef>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"

// Static, because the glTF library contains its own copies of both libraries, which would clash at
// link time.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>

namespace handhold {
namespace {

constexpr int k_channels = 4;

void append_bytes(void* context, void* data, int size) {
    auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), bytes, bytes + size);
}

}  // namespace

const std::uint8_t* Image::pixel(int x, int y) const {
    HH_CHECK(x >= 0 && x < width_px, "no such column", x);
    HH_CHECK(y >= 0 && y < height_px, "no such row", y);
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px);
    return &rgba[(row + static_cast<std::size_t>(x)) * static_cast<std::size_t>(k_channels)];
}

std::vector<std::uint8_t> encode_png(const Image& image) {
    std::vector<std::uint8_t> png;
    if (image.rgba.empty()) {
        return png;
    }
    stbi_write_png_to_func(append_bytes, &png, image.width_px, image.height_px, k_channels,
                           image.rgba.data(), image.width_px * k_channels);
    return png;
}

std::optional<Image> decode_png(std::span<const std::uint8_t> bytes) {
    Image image;
    int channels = 0;
    stbi_uc* pixels =
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &image.width_px,
                              &image.height_px, &channels, k_channels);
    if (pixels == nullptr) {
        return std::nullopt;
    }
    const auto count = static_cast<std::ptrdiff_t>(image.width_px) * image.height_px * k_channels;
    image.rgba.assign(pixels, pixels + count);
    stbi_image_free(pixels);
    return image;
}

std::optional<FileError> save_png(const Image& image, const std::string& path) {
    const std::vector<std::uint8_t> png = encode_png(image);
    if (png.empty()) {
        return FileError{path, "", "expected a picture, found an empty one"};
    }
    return write_file_atomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

std::string encode_base64(std::span<const std::uint8_t> bytes) {
    constexpr char k_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = bytes.size() - i;
        std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16U;
        group |= left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) << 8U : 0U;
        group |= left > 2 ? static_cast<std::uint32_t>(bytes[i + 2]) : 0U;
        text += k_digits[(group >> 18U) & 63U];
        text += k_digits[(group >> 12U) & 63U];
        text += left > 1 ? k_digits[(group >> 6U) & 63U] : '=';
        text += left > 2 ? k_digits[group & 63U] : '=';
    }
    return text;
}

}  // namespace handhold
