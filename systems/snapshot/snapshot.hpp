#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "components/world.hpp"
#include "engine/core/result.hpp"
#include "engine/geometry/shape_library.hpp"

// Saves, restores and compares whole worlds: rollback, saved games, and finding where two runs
// diverge. Format: docs/reference/snapshot_format.md.
namespace handhold {

// Identifies the assets that a world refers to and a snapshot omits: the shapes of its colliders,
// by their content. Make it once per scene: it hashes every vertex of every mesh.
class SnapshotAssets {
  public:
    // What a host knows of its shapes beyond their geometry.
    struct OfHost {
        // By ShapeId::index: the frame in which the host made the shape. Part of the content: poses
        // that the host reads depend on it. Shapes without an element: the identity.
        std::span<const Pose> frames;
        std::span<const ShapeId> heads;  // spheres of players' heads, which are no body's shape
    };

    // `shapes` must outlive this object and not change. `scene`: the host's name of the scene.
    explicit SnapshotAssets(const ShapeLibrary& shapes, std::string_view scene = {})
        : SnapshotAssets(shapes, scene, OfHost{}) {}
    SnapshotAssets(const ShapeLibrary& shapes, std::string_view scene, const OfHost& host);

    const ShapeLibrary& shapes() const { return *shapes_; }
    // Hash of the scene's name and all shapes.
    std::uint64_t hash() const { return hash_; }
    // Hash of the scene's name alone.
    std::uint64_t scene_hash() const { return scene_hash_; }
    // Hash of a shape's content; 0: there is no shape with this id.
    std::uint64_t digest(ShapeId shape) const {
        return shape.index < digests_.size() ? digests_[shape.index] : 0;
    }
    // The shape with this content and the lowest id; k_no_shape: none.
    ShapeId find(std::uint64_t digest) const;
    // True if a player's head may have this shape: a sphere with this radius, and one of
    // OfHost::heads unless that is empty.
    bool is_head(ShapeId shape, double radius_m) const;
    // The lowest such shape; k_no_shape: none.
    ShapeId find_head(double radius_m) const;

  private:
    const ShapeLibrary* shapes_;
    std::vector<ShapeId> heads_;
    std::uint64_t hash_ = 0;
    std::uint64_t scene_hash_ = 0;
    std::vector<std::uint64_t> digests_;                              // indexed by ShapeId::index
    std::vector<std::pair<std::uint64_t, std::uint32_t>> by_digest_;  // digest and index; sorted
};

// Makes the spheres of players' heads that a restored world has and the library lacks.
struct MissingHeads {
    double smallest_m = 0.0;  // radius
    double largest_m = 0.0;   // 0: heads are not made
    // Adds a sphere to the library. Called only for snapshots that are good in everything else.
    std::function<ShapeId(double radius_m)> make;

    bool can_make(double radius_m) const {
        return radius_m >= smallest_m && radius_m <= largest_m;  // NaN: false
    }
};

// Call between frames only. Shapes are saved by their content: the library of the restored world
// may hold other shapes too, and the same ones with other ids. Saves every bit of the columns, the
// clock and the entity pool (free slots, generations, order of elements). Overwrites `bytes`;
// allocates nothing if its capacity suffices, except in the first call of the process.
void save_snapshot(const World& world, const SnapshotAssets& assets, std::vector<std::byte>& bytes);

// The restored world continues bit for bit like the saved one, with any caches built for `assets`
// that have the same hand rigs and body clips (not checked). Entity handles taken before the save
// are valid again. Returns an error, with its place and what was expected, and leaves the world
// unchanged, for: bytes that are no snapshot, truncated or damaged; another format or schema (the
// first differing field is named); another scene's name; a shape of a collider that `assets` lacks
// and `heads` cannot make;
// and any state that step_frame could not run on
// (docs/reference/snapshot_format.md). Memory use is at most proportional to the size of `bytes`,
// never to a number in them.
[[nodiscard]] std::optional<FileError> restore_snapshot(std::span<const std::byte> bytes,
                                                        const SnapshotAssets& assets, World& world,
                                                        const MissingHeads& heads = {});

// save_snapshot and restore_snapshot with a file. Saving is atomic: the file is replaced completely
// or not at all.
[[nodiscard]] std::optional<FileError> save_snapshot_file(const std::filesystem::path& path,
                                                          const World& world,
                                                          const SnapshotAssets& assets);
[[nodiscard]] std::optional<FileError> load_snapshot_file(const std::filesystem::path& path,
                                                          const SnapshotAssets& assets,
                                                          World& world);

struct WorldDiffSettings {
    std::size_t limit = 20;  // maximum number of differences listed
    // Names of entities for the messages; entities without a name are shown by id.
    std::span<const std::string> names = {};
    bool simulated_only = false;  // true: leaves out the shown columns (k_is_shown)
};
// Lists the fields in which two worlds differ, bit for bit, by persistent id, in the order of the
// columns and of the elements of `a`: "head_tracking[player].pose_ps.position.x: a 0.1, b 0.2",
// "grab[0x5d...1]: only in a". As in hash_state, slots and the order of elements are ignored; but
// shape ids are compared.
std::vector<std::string> diff_worlds(const World& a, const World& b,
                                     const WorldDiffSettings& settings = {});

}  // namespace handhold
