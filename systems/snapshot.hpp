#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/world.hpp"
#include "engine/collision/shape_library.hpp"
#include "engine/io/result.hpp"

// The whole state as bytes: rollback, saved games, and the place where two runs part. The format is
// docs/reference/snapshot_format.md.
namespace handhold {

// What a world refers to and a snapshot leaves out: the shapes of its colliders. Make it once a
// scene: every vertex of every mesh is hashed.
class SnapshotAssets {
  public:
    // `shapes` must outlive this and not change. `scene` is the host's name for what is played.
    explicit SnapshotAssets(const ShapeLibrary& shapes, std::string_view scene = {});

    const ShapeLibrary& shapes() const { return *shapes_; }
    std::uint64_t hash() const { return hash_; }

  private:
    const ShapeLibrary* shapes_;
    std::uint64_t hash_ = 0;
};

// Between two frames only. Every bit of the columns, the clock and the pool of entities: free
// slots, generations, the order of rows. `bytes` is overwritten; where its capacity suffices,
// nothing is allocated but at the first call of all.
void save_snapshot(const World& world, const SnapshotAssets& assets, std::vector<std::byte>& bytes);

// The world continues bit for bit as the saved one, with any caches that fit `assets` and have the
// same hand rigs and body clips, which nothing checks; handles
// taken before are good again. Refused, with the place in the bytes and what was expected there,
// and the world is as it was: what is no snapshot, of another format, schema (the first column or
// field that differs is named) or other assets, cut short or damaged; and what step_frame could not
// run on (docs/reference/snapshot_format.md lists it), whoever made it. Memory taken is at most
// proportional to the bytes given, never to a number in them.
[[nodiscard]] std::optional<FileError> restore_snapshot(std::span<const std::byte> bytes,
                                                        const SnapshotAssets& assets, World& world);

// The same by way of a file. Saving replaces the file at once or not at all.
[[nodiscard]] std::optional<FileError> save_snapshot_file(const std::filesystem::path& path,
                                                          const World& world,
                                                          const SnapshotAssets& assets);
[[nodiscard]] std::optional<FileError> load_snapshot_file(const std::filesystem::path& path,
                                                          const SnapshotAssets& assets,
                                                          World& world);

struct WorldDiffSettings {
    std::size_t limit = 20;              // differences listed
    std::span<const std::string> names;  // entities to be called by their names; others by number
};
// Where two worlds differ, bit for bit, by persistent id, in the order of the columns and of a's
// rows: "head_tracking[player].pose_ps.position.x: a 0.1, b 0.2", "grab[0x5d...1]: only in a".
// Slots and the order of rows do not count, as in hash_state; numbers of shapes do.
std::vector<std::string> diff_worlds(const World& a, const World& b,
                                     const WorldDiffSettings& settings = {});

}  // namespace handhold
