#include "engine/io/glb.hpp"

#include <utility>

namespace handhold {
namespace {

constexpr std::uint32_t k_glb_magic = 0x46546C67;   // "glTF"
constexpr std::uint32_t k_json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t k_bin_chunk = 0x004E4942;   // "BIN"
constexpr std::size_t k_glb_header_bytes = 12;
constexpr std::size_t k_chunk_header_bytes = 8;

}  // namespace

void append_u32(std::string& bytes, std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes += static_cast<char>((value >> shift) & 0xFFU);
    }
}

std::uint32_t read_u32(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
    }
    return value;
}

Result<GlbChunks> split_glb(std::string_view bytes, const std::string& file) {
    if (bytes.size() < 4 || read_u32(bytes, 0) != k_glb_magic) {
        return GlbChunks{bytes, {}};
    }
    const auto refuse = [&](std::size_t offset, std::string expected) {
        return FileError{file, "byte " + std::to_string(offset), std::move(expected)};
    };
    if (bytes.size() < k_glb_header_bytes + k_chunk_header_bytes) {
        return refuse(bytes.size(), "expected the header of a .glb, found the end of the file");
    }
    if (read_u32(bytes, 4) != 2) {
        return refuse(4, "expected version 2, found " + std::to_string(read_u32(bytes, 4)));
    }
    if (read_u32(bytes, 8) != bytes.size()) {
        return refuse(8, "expected the length of the file, " + std::to_string(bytes.size()) +
                             ", found " + std::to_string(read_u32(bytes, 8)));
    }
    GlbChunks chunks;
    for (std::size_t at = k_glb_header_bytes, chunk = 0; at < bytes.size(); ++chunk) {
        if (bytes.size() - at < k_chunk_header_bytes) {
            return refuse(at, "expected a chunk header of 8 bytes, found " +
                                  std::to_string(bytes.size() - at));
        }
        const std::size_t length = read_u32(bytes, at);
        const std::size_t rest = bytes.size() - at - k_chunk_header_bytes;
        if (length > rest) {
            return refuse(at, "expected a chunk of at most " + std::to_string(rest) +
                                  " bytes, found a length of " + std::to_string(length));
        }
        const std::uint32_t type = read_u32(bytes, at + 4);
        const std::string_view content = bytes.substr(at + k_chunk_header_bytes, length);
        if (chunk == 0 && type != k_json_chunk) {
            return refuse(at + 4, "expected a chunk of type JSON first");
        }
        if (chunk == 0) {
            chunks.json = content;
        } else if (chunk == 1 && type == k_bin_chunk) {
            chunks.binary = content;
        }  // other chunks are ignored, as the specification requires
        at += k_chunk_header_bytes + length;
    }
    return chunks;
}

std::string join_glb(std::string json, std::string_view binary) {
    const auto pad = [](std::size_t size) { return (4 - size % 4) % 4; };
    json.append(pad(json.size()), ' ');
    const std::size_t binary_size = binary.size() + pad(binary.size());
    const std::size_t total = k_glb_header_bytes + k_chunk_header_bytes + json.size() +
                              (binary.empty() ? 0 : k_chunk_header_bytes + binary_size);
    std::string glb;
    glb.reserve(total);
    append_u32(glb, k_glb_magic);
    append_u32(glb, 2);
    append_u32(glb, static_cast<std::uint32_t>(total));
    append_u32(glb, static_cast<std::uint32_t>(json.size()));
    append_u32(glb, k_json_chunk);
    glb += json;
    if (!binary.empty()) {
        append_u32(glb, static_cast<std::uint32_t>(binary_size));
        append_u32(glb, k_bin_chunk);
        glb += binary;
        glb.append(pad(binary.size()), '\0');
    }
    return glb;
}

}  // namespace handhold
