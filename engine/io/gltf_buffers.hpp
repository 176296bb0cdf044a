#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/gltf_model.hpp"

namespace handhold::gltf {

// The bytes of a model's buffers. Private to engine/io/gltf*.
class Buffers {
  public:
    // Reads data URIs and files below the folder of `path`; data URIs only if `path` is empty.
    // Refuses any other URI, a file that cannot be read, fewer bytes than the buffer claims, and
    // more than k_max_file_bytes in total.
    bool load(const Model& model, const std::filesystem::path& path, Refusal& refusal);

    // The bytes of each buffer; empty for a fallback buffer. A buffer in the binary chunk points
    // into the parsed bytes.
    const std::vector<std::string_view>& bytes() const { return bytes_; }

  private:
    std::vector<std::string> owned_;
    std::vector<std::string_view> bytes_;
};

}  // namespace handhold::gltf
