#include <algorithm>
#include <cstring>
#include <vector>

#include "systems/frame/frame.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/fuzz/promise.hpp"
#include "tests/systems/snapshot/snapshot_bytes.hpp"

namespace handhold::fuzz {
namespace {

using test::SnapshotBytes;

// A player who holds a wall and a rock on a hinge, movers, and a destroyed entity.
struct Base {
    ShapeLibrary shapes;
    World world;
    std::vector<std::byte> bytes;

    Base() {
        add_body(world, {"wall", {}, {}, {}, shapes.add_box(Vec3(2.0, 2.0, 0.1))});
        const ShapeId pebble = shapes.add_sphere(0.1);
        const RigidBody stone{BodyKind::free, 2.0, Vec3::Constant(0.01), 0.5};
        const Entity gone = add_body(world, {"gone", stone, {}, {}, pebble});
        const Entity rock =
            add_body(world, {"rock", stone, {Vec3(0.2, 1.2, 0.3), Quat::Identity()}, {}, pebble});
        add_body(world, {"stone", stone, {Vec3(0.2, 1.35, 0.3), Quat::Identity()}, {}, pebble});
        RigidBody driven;
        driven.kind = BodyKind::kinematic;
        const Entity rotor =
            add_body(world, {"rotor", driven, {Vec3(0.0, 0.0, 1.0), Quat::Identity()}, {}, pebble});
        world.mover.add(rotor, {{}, Vec3::UnitX(), Vec3::UnitY(), true});
        const PlayerEntities player = add_player(world, {"player", {}, {}, Vec3::Zero(), pebble});
        world.controller_to_hand.add(player.hands[0]);
        destroy(world, gone);

        FrameCaches caches(shapes);
        StageStats stats;
        for (int frame = 0; frame < 6; ++frame) {
            TrackingSample sample;
            sample.t_s = world.clock.t_s + 0.01;
            sample.head_ps.position = Vec3(0.0, 1.6, 0.6);
            sample.controllers[0] = {{Vec3(-0.3, 1.2, 0.15), Quat::Identity()}, frame > 1};
            sample.controllers[1] = {{Vec3(0.2, 1.3, 0.35), Quat::Identity()}, frame > 2};
            const PlayerInput input{player.player, {&sample, 1}, {}};
            step_frame(world, caches, {}, {0.01, {&input, 1}}, stats);
        }
        promise(world.grab.at(player.hands[0]).kind == GripKind::surface, "the wall is gripped");
        promise(world.grab.at(player.hands[1]).body == rock ||
                    world.grab.at(player.hands[1]).kind == GripKind::held,
                "something is held");
        save_snapshot(world, SnapshotAssets(shapes), bytes);
    }
};

// Each patch: two bytes of offset, a byte of length, and the bytes.
SnapshotBytes patched(const Base& base, Bytes patches) {
    SnapshotBytes snapshot(base.bytes);
    const std::size_t begin = SnapshotBytes::payload_begin();
    const std::size_t size = snapshot.bytes.size() - begin - SnapshotBytes::k_checksum_bytes;
    while (patches.size() > 3) {
        const std::size_t place = (std::size_t{patches[0]} | std::size_t{patches[1]} << 8U) % size;
        const std::size_t length =
            std::min({std::size_t{patches[2]} % 32U, patches.size() - 3, size - place});
        std::memcpy(snapshot.bytes.data() + begin + place, patches.data() + 3, length);
        patches = patches.subspan(3 + length);
    }
    snapshot.seal();
    return snapshot;
}

SnapshotBytes with_payload(const Base& base, Bytes payload) {
    SnapshotBytes snapshot(base.bytes);
    snapshot.bytes.resize(SnapshotBytes::payload_begin());
    const auto bytes = std::as_bytes(payload);
    snapshot.bytes.insert(snapshot.bytes.end(), bytes.begin(), bytes.end());
    snapshot.bytes.resize(snapshot.bytes.size() + SnapshotBytes::k_checksum_bytes);
    constexpr std::size_t k_size_at = 16;
    snapshot.put(k_size_at, std::uint64_t{snapshot.bytes.size()});
    return snapshot;
}

SnapshotBytes whole(Bytes bytes) {
    const auto all = std::as_bytes(bytes);
    SnapshotBytes snapshot(std::vector<std::byte>(all.begin(), all.end()));
    snapshot.seal();
    return snapshot;
}

}  // namespace

void run_snapshot(Bytes bytes) {
    static const Base k_base;
    if (bytes.empty()) {
        return;
    }
    const Bytes rest = bytes.subspan(1);
    const SnapshotBytes snapshot = bytes[0] == 0   ? patched(k_base, rest)
                                   : bytes[0] == 1 ? with_payload(k_base, rest)
                                                   : whole(rest);
    const SnapshotAssets assets(k_base.shapes);
    World world = k_base.world;
    if (const auto error = restore_snapshot(snapshot.bytes, assets, world)) {
        promise(!error->expected.empty(), "a refusal says what was expected");
        promise(hash_state(world) == hash_state(k_base.world), "a refusal changes nothing");
        return;
    }
    std::vector<std::byte> again;
    save_snapshot(world, assets, again);
    promise(again == snapshot.bytes, "what was restored is what was saved");
    FrameCaches caches(k_base.shapes);
    StageStats stats;
    for (int frame = 0; frame < 2; ++frame) {
        step_frame(world, caches, {}, {0.01, {}}, stats);
    }
}

}  // namespace handhold::fuzz
