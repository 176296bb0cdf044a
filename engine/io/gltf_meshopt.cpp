#include "engine/io/gltf_meshopt.hpp"

#include <meshoptimizer.h>

namespace handhold::gltf {
namespace {

// Checks what the decoders assert, and that `bytes` can hold `view.count` elements. Shortest
// encodings (glTF registry, EXT_meshopt_compression, appendices A to C): 1 byte for a triangle or
// an index; 2 bits for 16 equal bytes of an attribute.
bool may_decode(const Meshopt& view, std::size_t bytes) {
    const bool is_index_stride = view.stride == 2 || view.stride == 4;
    switch (view.mode) {
        case Meshopt::Mode::triangles:
            return is_index_stride && view.count % 3 == 0 && view.count / 3 <= bytes;
        case Meshopt::Mode::indices:
            return is_index_stride && view.count <= bytes;
        case Meshopt::Mode::attributes:
            break;
    }
    if (view.stride % 4 != 0 || view.stride * view.count / 64 > bytes) {
        return false;
    }
    switch (view.filter) {
        case Meshopt::Filter::octahedral:
            return view.stride == 4 || view.stride == 8;
        case Meshopt::Filter::quaternion:
            return view.stride == 8;
        case Meshopt::Filter::none:
        case Meshopt::Filter::exponential:
            break;
    }
    return true;
}

}  // namespace

std::optional<std::string> decode_meshopt(const Meshopt& view, std::string_view compressed) {
    if (!may_decode(view, compressed.size())) {
        return std::nullopt;
    }
    std::string decoded(view.stride * view.count, '\0');
    const auto* const from = reinterpret_cast<const unsigned char*>(compressed.data());
    int failed = 0;
    switch (view.mode) {
        case Meshopt::Mode::triangles:
            failed = meshopt_decodeIndexBuffer(decoded.data(), view.count, view.stride, from,
                                               compressed.size());
            break;
        case Meshopt::Mode::indices:
            failed = meshopt_decodeIndexSequence(decoded.data(), view.count, view.stride, from,
                                                 compressed.size());
            break;
        case Meshopt::Mode::attributes:
            failed = meshopt_decodeVertexBuffer(decoded.data(), view.count, view.stride, from,
                                                compressed.size());
            break;
    }
    if (failed != 0) {
        return std::nullopt;
    }
    switch (view.filter) {
        case Meshopt::Filter::octahedral:
            meshopt_decodeFilterOct(decoded.data(), view.count, view.stride);
            break;
        case Meshopt::Filter::quaternion:
            meshopt_decodeFilterQuat(decoded.data(), view.count, view.stride);
            break;
        case Meshopt::Filter::exponential:
            meshopt_decodeFilterExp(decoded.data(), view.count, view.stride);
            break;
        case Meshopt::Filter::none:
            break;
    }
    return decoded;
}

}  // namespace handhold::gltf
