#include "systems/snapshot/snapshot.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/text_file.hpp"
#include "systems/snapshot/snapshot_check.hpp"
#include "systems/snapshot/snapshot_payload.hpp"
#include "systems/snapshot/snapshot_schema.hpp"

namespace handhold {
namespace {

// First bytes of a snapshot. Like PNG's, they start with a byte that no text has, and end with a
// line feed that a text-mode transfer would alter.
constexpr char k_snapshot_magic[] = "\x89HHSNAP\n";
constexpr std::size_t k_magic_bytes = sizeof k_snapshot_magic - 1;
constexpr std::uint32_t k_format_version = 13;
// Byte offsets of the header's fields.
constexpr std::size_t k_version_at = k_magic_bytes;
constexpr std::size_t k_schema_size_at = k_version_at + 4;
constexpr std::size_t k_size_at = k_schema_size_at + 4;
constexpr std::size_t k_assets_at = k_size_at + 8;
// The header is followed by the schema, the payload, the colliders' shapes and the checksum.
constexpr std::size_t k_snapshot_header_bytes = k_assets_at + 8;
constexpr std::size_t k_checksum_bytes = 8;
// Each collider's shape is saved as its digest (u64) and kind (u8), a player's head as its radius
// (f64) and k_head_kind, in the order of the column. Then follows the number of colliders, u32.
constexpr std::size_t k_shape_bytes = 9;
constexpr std::byte k_head_kind{7};
constexpr std::size_t k_shape_count_bytes = 4;

std::uint64_t checksum_of(std::span<const std::byte> bytes) {
    HashStream stream;
    stream.add(std::uint64_t{bytes.size()});
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
        stream.add(load_little<std::uint64_t>(bytes.data() + at));
    }
    for (; at < bytes.size(); ++at) {
        stream.add(std::to_integer<std::uint64_t>(bytes[at]));
    }
    return stream.value();
}

std::uint32_t shape_count_in(std::span<const std::byte> bytes) {
    return load_little<std::uint32_t>(bytes.data() + bytes.size() - k_checksum_bytes -
                                      k_shape_count_bytes);
}
// 64 bits, because the count is not checked yet.
std::uint64_t bytes_of_shapes(std::span<const std::byte> bytes) {
    return std::uint64_t{shape_count_in(bytes)} * k_shape_bytes;
}

FileError refusal(std::size_t byte, const std::string& expected) {
    return {"snapshot", "byte " + std::to_string(byte), "expected " + expected};
}

// Checks everything but the payload: file type, version, size, checksum, schema, assets.
std::optional<FileError> check_envelope(std::span<const std::byte> bytes,
                                        const SnapshotAssets& assets) {
    if (bytes.size() < k_snapshot_header_bytes + k_shape_count_bytes + k_checksum_bytes ||
        std::memcmp(bytes.data(), k_snapshot_magic, k_magic_bytes) != 0) {
        return refusal(0, "a snapshot's first bytes, found something else");
    }
    const auto version = load_little<std::uint32_t>(bytes.data() + k_version_at);
    if (version != k_format_version) {
        return refusal(k_version_at, "format version " + std::to_string(k_format_version) +
                                         ", found " + std::to_string(version));
    }
    const auto size = load_little<std::uint64_t>(bytes.data() + k_size_at);
    if (size != bytes.size()) {
        return refusal(k_size_at, std::to_string(size) + " bytes as the header says, found " +
                                      std::to_string(bytes.size()));
    }
    const std::size_t checksum_at = bytes.size() - k_checksum_bytes;
    if (load_little<std::uint64_t>(bytes.data() + checksum_at) !=
        checksum_of(bytes.first(checksum_at))) {
        return refusal(checksum_at, "the checksum of what is before it: the snapshot is damaged");
    }
    const auto schema_bytes = load_little<std::uint32_t>(bytes.data() + k_schema_size_at);
    if (schema_bytes > checksum_at - k_shape_count_bytes - k_snapshot_header_bytes) {
        return refusal(k_schema_size_at, "a schema within the snapshot, found one of " +
                                             std::to_string(schema_bytes) + " bytes");
    }
    // Reading the bytes as char is allowed for any object.
    const std::string_view schema(
        reinterpret_cast<const char*>(bytes.data()) + k_snapshot_header_bytes, schema_bytes);
    if (schema != snapshot_schema()) {
        return FileError{"snapshot", "schema", schema_difference(snapshot_schema(), schema)};
    }
    if (load_little<std::uint64_t>(bytes.data() + k_assets_at) != assets.scene_hash()) {
        return refusal(k_assets_at, "a snapshot of this scene, found another's");
    }
    if (bytes_of_shapes(bytes) >
        checksum_at - k_shape_count_bytes - k_snapshot_header_bytes - schema_bytes) {
        return refusal(checksum_at - k_shape_count_bytes,
                       "as many shapes as fit into the snapshot, found more");
    }
    return std::nullopt;
}

std::byte* write_shapes(const World& world, const SnapshotAssets& assets, std::byte* at) {
    for (std::size_t index = 0; index < world.collider.size(); ++index) {
        const ShapeId id = world.collider.elements()[index].shape;
        const Shape* const shape = assets.shapes().has(id) ? &assets.shapes().at(id) : nullptr;
        if (shape != nullptr && world.player.contains(world.collider.owners()[index])) {
            store_little(std::bit_cast<std::uint64_t>(shape->radius_m), at);
            at[8] = k_head_kind;
        } else {
            store_little(assets.digest(id), at);
            at[8] = shape != nullptr ? static_cast<std::byte>(shape->kind) : std::byte{0xff};
        }
        at += k_shape_bytes;
    }
    store_little(static_cast<std::uint32_t>(world.collider.size()), at);
    return at + k_shape_count_bytes;
}

const char* kind_text(std::byte kind) {
    static constexpr std::array k_texts = {"box",  "sphere",   "capsule", "cylinder",
                                           "hull", "compound", "mesh",    "head's sphere"};
    const auto index = std::to_integer<std::size_t>(kind);
    return index < k_texts.size() ? k_texts[index] : "shape";
}

struct HeadToMake {
    Entity player;
    double radius_m = 0.0;
};

// Gives each collider the shape with the saved content. An id whose shape already has that content
// is kept. Heads that `heads` can make are not shapes yet: their colliders get k_no_shape.
std::optional<FileError> find_shapes(std::span<const std::byte> bytes, std::size_t shapes_at,
                                     const SnapshotAssets& assets, const MissingHeads& heads,
                                     World& world, std::vector<HeadToMake>& to_make) {
    if (shape_count_in(bytes) != world.collider.size()) {
        return refusal(shapes_at, "a shape for each collider");
    }
    for (std::size_t index = 0; index < world.collider.size(); ++index) {
        const std::size_t at = shapes_at + index * k_shape_bytes;
        const auto digest = load_little<std::uint64_t>(bytes.data() + at);
        const Entity owner = world.collider.owners()[index];
        ShapeId& shape = world.collider.elements()[index].shape;
        const bool is_head = bytes[at + 8] == k_head_kind;
        if (is_head != world.player.contains(owner)) {
            return refusal(at + 8, "the kind of a head for players, and another for bodies");
        }
        const auto radius_m = std::bit_cast<double>(digest);  // meaning for a head only
        if (is_head ? assets.is_head(shape, radius_m)
                    : digest != 0 && assets.digest(shape) == digest) {
            continue;
        }
        shape = is_head ? assets.find_head(radius_m) : assets.find(digest);
        if (is_head && shape == k_no_shape && heads.can_make(radius_m)) {
            to_make.push_back({owner, radius_m});
            continue;
        }
        if (digest == 0 || shape == k_no_shape) {
            return FileError{
                "snapshot",
                "byte " + std::to_string(at) + ": collider[" + std::to_string(index) + "].shape",
                std::string("expected a shape of this world, found a ") + kind_text(bytes[at + 8]) +
                    " that none of its shapes equals"};
        }
    }
    return std::nullopt;
}

}  // namespace

void save_snapshot(const World& world, const SnapshotAssets& assets,
                   std::vector<std::byte>& bytes) {
    const std::string& schema = snapshot_schema();
    bytes.resize(k_snapshot_header_bytes + schema.size() + payload_bytes(world) +
                 world.collider.size() * k_shape_bytes + k_shape_count_bytes + k_checksum_bytes);
    std::memcpy(bytes.data(), k_snapshot_magic, k_magic_bytes);
    store_little(k_format_version, bytes.data() + k_version_at);
    store_little(static_cast<std::uint32_t>(schema.size()), bytes.data() + k_schema_size_at);
    store_little(std::uint64_t{bytes.size()}, bytes.data() + k_size_at);
    store_little(assets.scene_hash(), bytes.data() + k_assets_at);
    std::memcpy(bytes.data() + k_snapshot_header_bytes, schema.data(), schema.size());
    const std::byte* const end =
        write_shapes(world, assets,
                     write_payload(world, bytes.data() + k_snapshot_header_bytes + schema.size()));
    const auto written = static_cast<std::size_t>(end - bytes.data());
    HH_CHECK(written + k_checksum_bytes == bytes.size(), "bytes were counted wrong", written);
    store_little(checksum_of(std::span(bytes).first(written)), bytes.data() + written);
}

std::optional<FileError> restore_snapshot(std::span<const std::byte> bytes,
                                          const SnapshotAssets& assets, World& world,
                                          const MissingHeads& heads) {
    if (std::optional<FileError> error = check_envelope(bytes, assets)) {
        return error;
    }
    World restored;
    const std::size_t shapes_at = bytes.size() - k_checksum_bytes - k_shape_count_bytes -
                                  static_cast<std::size_t>(bytes_of_shapes(bytes));
    if (std::optional<FileError> error = read_payload(
            bytes, k_snapshot_header_bytes + snapshot_schema().size(), shapes_at, restored)) {
        return error;
    }
    std::vector<HeadToMake> to_make;
    if (std::optional<FileError> error =
            find_shapes(bytes, shapes_at, assets, heads, restored, to_make)) {
        return error;
    }
    if (const std::optional<WorldBreach> breach = find_breach(restored, assets.shapes())) {
        return FileError{"snapshot", breach->place, breach->expected};
    }
    for (const auto& [player, radius_m] : to_make) {
        restored.collider.at(player).shape = heads.make(radius_m);
    }
    sync_index(restored);
    restored.name_of_id = std::move(world.name_of_id);
    world = std::move(restored);
    return std::nullopt;
}

std::optional<FileError> save_snapshot_file(const std::filesystem::path& path, const World& world,
                                            const SnapshotAssets& assets) {
    std::vector<std::byte> bytes;
    save_snapshot(world, assets, bytes);
    return write_file_atomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<FileError> load_snapshot_file(const std::filesystem::path& path,
                                            const SnapshotAssets& assets, World& world) {
    const Result<std::string> content = read_file(path);
    if (!content) {
        return content.error();
    }
    const std::span<const char> text = content.value();
    std::optional<FileError> error = restore_snapshot(std::as_bytes(text), assets, world);
    if (error) {
        error->file = path.string();
    }
    return error;
}

}  // namespace handhold
