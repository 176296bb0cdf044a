#include "engine/geometry/grip_mesh_cache.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <system_error>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/core/text_file.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/shape_surface.hpp"

namespace handhold {
namespace {

namespace fs = std::filesystem;

// Increment whenever the format changes, or the result of the build for the same input.
constexpr std::uint64_t k_version = 2;
constexpr std::uint64_t k_cache_magic = 0x0148534d50495248ULL;  // "HRIPMSH" and 1
constexpr std::size_t k_header_words = 4;                       // magic, key, word count, checksum

static_assert(std::endian::native == std::endian::little, "files are little-endian");

// All data are 8-byte words, so they are aligned and the checksum covers them all.
class WordWriter {
  public:
    void add(std::uint64_t word) { words_.push_back(word); }
    void add(const Vec3& v) {
        for (const double x : v) {
            add(std::bit_cast<std::uint64_t>(x));
        }
    }
    const std::vector<std::uint64_t>& words() const { return words_; }

  private:
    std::vector<std::uint64_t> words_;
};

// Returns zeros after the end of the data; at_end() is then false.
class WordReader {
  public:
    explicit WordReader(const std::vector<std::uint64_t>& words) : words_(words) {}
    std::uint64_t take() {
        is_valid_ = is_valid_ && next_ < words_.size();
        return is_valid_ ? words_[next_++] : 0;
    }
    Vec3 take_vector() {
        Vec3 v;
        for (double& x : v) {
            x = std::bit_cast<double>(take());
        }
        return v;
    }
    // Number of elements that follow; 0 if that many do not fit into the remaining words.
    std::size_t take_count(std::size_t words_each) {
        const std::uint64_t count = take();
        is_valid_ = is_valid_ && count <= (words_.size() - next_) / words_each;
        return is_valid_ ? static_cast<std::size_t>(count) : 0;
    }
    bool at_end() const { return is_valid_ && next_ == words_.size(); }

  private:
    const std::vector<std::uint64_t>& words_;
    std::size_t next_ = 0;
    bool is_valid_ = true;
};

std::uint64_t pair_of(std::uint32_t low, std::uint32_t high) {
    return low | (static_cast<std::uint64_t>(high) << 32U);
}
std::uint32_t low_of(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
std::uint32_t high_of(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32U); }

template <typename Report, typename Visit>
void visit_report(Report& report, const Visit& visit) {
    for (auto* field :
         {&report.triangles, &report.not_finite, &report.degenerate, &report.duplicate,
          &report.kept, &report.cut_in, &report.sewn_vertices, &report.border_edges,
          &report.non_manifold_edges, &report.flipped_links, &report.parts}) {
        visit(*field);
    }
}

void write_graph(const SurfaceGraph& graph, WordWriter& out) {
    visit_report(graph.report, [&](std::uint32_t field) { out.add(field); });
    out.add(graph.positions.size());
    for (const Vec3& position : graph.positions) {
        out.add(position);
    }
    out.add(graph.triangles.size());
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        const auto& [a, b, c] = graph.triangles[t];
        const auto& [ab, bc, ca] = graph.neighbours[t];
        out.add(pair_of(a, b));
        out.add(pair_of(c, ab));
        out.add(pair_of(bc, ca));
        out.add(graph.source_triangle[t]);
    }
}

// False if an index is out of range. Damaged files do not get here: the checksum excludes them.
bool read_graph(WordReader& in, SurfaceGraph& graph) {
    visit_report(graph.report, [&](std::uint32_t& field) { field = low_of(in.take()); });
    graph.positions.resize(in.take_count(3));
    for (Vec3& position : graph.positions) {
        position = in.take_vector();
    }
    const std::size_t count = in.take_count(4);
    graph.triangles.resize(count);
    graph.neighbours.resize(count);
    graph.source_triangle.resize(count);
    graph.normals.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
        const std::array<std::uint64_t, 3> words = {in.take(), in.take(), in.take()};
        graph.triangles[t] = {low_of(words[0]), high_of(words[0]), low_of(words[1])};
        graph.neighbours[t] = {high_of(words[1]), low_of(words[2]), high_of(words[2])};
        graph.source_triangle[t] = low_of(in.take());
        const auto& [a, b, c] = graph.triangles[t];
        if (std::max({a, b, c}) >= graph.positions.size()) {
            return false;
        }
        for (const std::uint32_t n : graph.neighbours[t]) {
            if (n != k_no_triangle && n >= count) {
                return false;
            }
        }
        // Recomputes the normals, bitwise equal to those of link_graph.
        graph.normals[t] =
            area_vector({graph.positions[a], graph.positions[b], graph.positions[c]}).normalized();
    }
    return true;
}

std::uint64_t sum_of(const std::vector<std::uint64_t>& words) {
    HashStream hash;
    for (const std::uint64_t word : words) {
        hash.add(word);
    }
    return hash.value();
}

std::string file_name(std::uint64_t key) {
    constexpr std::string_view k_digits = "0123456789abcdef";
    std::string name = "grip_";
    for (unsigned shift = 64; shift > 0; shift -= 4) {
        name += k_digits[(key >> (shift - 4)) & 15U];
    }
    return name + ".bin";
}

}  // namespace

std::uint64_t grip_mesh_key(const Mesh& mesh, const GripMeshSettings& settings) {
    HashStream hash;
    hash.add(k_version);
    for (const double setting :
         {settings.weld.point_m, settings.weld.seam_m, settings.weld.seam_per_size,
          settings.weld.seam_per_edge, settings.shape_tolerance_m, settings.search.deviation_m,
          settings.search.edge_m, settings.contact.deviation_m, settings.contact.edge_m,
          settings.contact_share, settings.flip_below_m}) {
        hash.add(setting);
    }
    hash.add(static_cast<std::uint64_t>(mesh.positions.size()));
    for (const Vec3& position : mesh.positions) {
        for (const double x : position) {
            hash.add(x);
        }
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        hash.add(pair_of(a, b));
        hash.add(static_cast<std::uint64_t>(c));
    }
    return hash.value();
}

std::string write_grip_mesh(const GripMesh& grip, std::uint64_t key) {
    WordWriter body;
    write_graph(grip.contact, body);
    write_graph(grip.search, body);
    body.add(pair_of(grip.turned, grip.full_triangles));
    const std::array<std::uint64_t, k_header_words> header = {
        k_cache_magic, key, body.words().size(), sum_of(body.words())};
    std::string bytes(sizeof header + sizeof(std::uint64_t) * body.words().size(), '\0');
    std::memcpy(bytes.data(), header.data(), sizeof header);
    std::memcpy(bytes.data() + sizeof header, body.words().data(), bytes.size() - sizeof header);
    return bytes;
}

std::optional<GripMesh> read_grip_mesh(std::string_view bytes, std::uint64_t key) {
    std::array<std::uint64_t, k_header_words> header = {};
    if (bytes.size() < sizeof header || bytes.size() % sizeof(std::uint64_t) != 0) {
        return std::nullopt;
    }
    std::memcpy(header.data(), bytes.data(), sizeof header);
    std::vector<std::uint64_t> words((bytes.size() - sizeof header) / sizeof(std::uint64_t));
    std::memcpy(words.data(), bytes.data() + sizeof header, bytes.size() - sizeof header);
    if (header[0] != k_cache_magic || header[1] != key || header[2] != words.size() ||
        header[3] != sum_of(words)) {
        return std::nullopt;
    }
    WordReader in(words);
    GripMesh grip;
    if (!read_graph(in, grip.contact) || !read_graph(in, grip.search)) {
        return std::nullopt;
    }
    const std::uint64_t counts = in.take();
    if (!in.at_end()) {
        return std::nullopt;
    }
    grip.turned = low_of(counts);
    grip.full_triangles = high_of(counts);
    grip.contact_bvh = TriangleBvh(grip.contact.positions, grip.contact.triangles);
    grip.search_bvh = TriangleBvh(grip.search.positions, grip.search.triangles);
    grip.digest = digest_of(grip.contact);
    return grip;
}

GripMesh cached_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings,
                          const fs::path& directory) {
    if (directory.empty()) {
        return build_grip_mesh(mesh, settings);
    }
    const std::uint64_t key = grip_mesh_key(mesh, settings);
    const fs::path file = directory / file_name(key);
    if (const Result<std::string> bytes = read_file(file)) {
        if (std::optional<GripMesh> found = read_grip_mesh(bytes.value(), key)) {
            return *std::move(found);
        }
    }
    GripMesh grip = build_grip_mesh(mesh, settings);
    std::error_code error;
    fs::create_directories(directory, error);
    // A cache that cannot be written is not an error: the next load builds the mesh again.
    static_cast<void>(write_file_atomically(file, write_grip_mesh(grip, key)));
    return grip;
}

GripMesh cached_grip_mesh(const Shape& shape, const GripMeshSettings& settings,
                          const fs::path& directory) {
    // Only meshes are cached: building another shape takes no longer than reading a file.
    if (shape.kind != ShapeKind::mesh) {
        return build_grip_mesh(shape, settings);
    }
    if (shape.scale == Vec3::Ones()) {
        return cached_grip_mesh(*shape.mesh, settings, directory);  // no copy of a large mesh
    }
    return cached_grip_mesh(shape_surface(shape, settings.shape_tolerance_m), settings, directory);
}

}  // namespace handhold
