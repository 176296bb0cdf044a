// Structs of the C interface get fields in later versions: hosts of every version work with a
// library of every version, and none reads or writes beyond what the other knows.
#include <array>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "systems/host/host_growth.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_growth_test {
namespace {

using namespace test;

using Bytes = std::vector<unsigned char>;

// A struct with a head, `count` nested structs and a tail, in a version with these sizes.
struct Version {
    std::size_t nested_size;
    std::size_t tail_size;
};
constexpr std::size_t k_head_size = 24;
constexpr unsigned char k_unwritten = 0xa5;

NestedLayout layout_of(const Version& version, std::size_t count) {
    const std::size_t size = k_head_size + count * version.nested_size + version.tail_size;
    return {size, version.nested_size, k_head_size, count};
}

// What a field's byte holds: the same in every version that has the field.
unsigned char head_byte(std::size_t at) { return static_cast<unsigned char>(1 + at); }
unsigned char nested_byte(std::size_t i, std::size_t at) {
    return static_cast<unsigned char>(50 + 40 * i + at);
}
unsigned char tail_byte(std::size_t at) { return static_cast<unsigned char>(200 + at); }

Bytes filled(const Version& version, std::size_t count) {
    Bytes bytes;
    for (std::size_t at = 0; at < k_head_size; ++at) {
        bytes.push_back(head_byte(at));
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t at = 0; at < version.nested_size; ++at) {
            bytes.push_back(nested_byte(i, at));
        }
    }
    for (std::size_t at = 0; at < version.tail_size; ++at) {
        bytes.push_back(tail_byte(at));
    }
    return bytes;
}

RC_GTEST_PROP(HostGrowth, VersionsExchangeExactlyTheFieldsThatBothKnow, ()) {
    const auto any_version = [] {
        return Version{*rc::gen::inRange<std::size_t>(1, 40),
                       *rc::gen::inRange<std::size_t>(0, 40)};
    };
    const Version from = any_version();
    const Version to = any_version();
    const std::size_t count = *rc::gen::inRange<std::size_t>(1, 4);
    Bytes out(layout_of(to, count).size + 16, k_unwritten);
    copy_common_fields(out.data(), layout_of(to, count), filled(from, count).data(),
                       layout_of(from, count));
    // The oracle writes field by field.
    Bytes expected(out.size(), k_unwritten);
    const Bytes wanted = filled(to, count);
    for (std::size_t at = 0; at < wanted.size(); ++at) {
        const std::size_t behind_head = at - std::min(at, k_head_size);
        const std::size_t nested_bytes = count * to.nested_size;
        const bool is_tail = at >= k_head_size + nested_bytes;
        const bool is_known =
            at < k_head_size || (is_tail ? behind_head - nested_bytes < from.tail_size
                                         : behind_head % to.nested_size < from.nested_size);
        expected[at] = is_known ? wanted[at] : k_unwritten;
    }
    RC_ASSERT(out == expected);
}

// A struct in its first and in a later version.
struct FirstDef {
    std::uint32_t struct_size;
    double length;
};
struct LaterDef {
    std::uint32_t struct_size;
    double length;
    double width;
};

TEST(HostGrowth, FieldsThatAHostDoesNotKnowKeepTheirDefaults) {
    const LaterDef defaults{sizeof(LaterDef), 1.0, 2.0};
    std::array<LaterDef, 1> memory{{{sizeof(FirstDef), 5.0, -1.0}}};
    const LaterDef read = read_def(memory.data(), defaults, sizeof(FirstDef));
    EXPECT_EQ(read.length, 5.0);
    EXPECT_EQ(read.width, 2.0);
    memory[0].struct_size = sizeof(LaterDef) + 8;  // a later library's
    EXPECT_THROW(read_def(memory.data(), defaults, sizeof(FirstDef)), HostError);
    memory[0].struct_size = 0;  // a program that set no size
    EXPECT_THROW(read_def(memory.data(), defaults, sizeof(FirstDef)), HostError);
}

TEST(HostGrowth, DefaultsNeverWriteBeyondTheHostsStruct) {
    LaterDef memory{7, 7.0, 7.0};
    EXPECT_EQ(write_default(&memory, sizeof(FirstDef), LaterDef{0, 1.0, 2.0}, sizeof(FirstDef)),
              HH_OK);
    EXPECT_EQ(memory.struct_size, sizeof(FirstDef));
    EXPECT_EQ(memory.length, 1.0);
    EXPECT_EQ(memory.width, 7.0);
    // A host of a later version gets zeros, and its calls are refused.
    struct {
        LaterDef def;
        double later = 7.0;
    } host;
    EXPECT_EQ(write_default(&host.def, sizeof host, LaterDef{0, 1.0, 2.0}), HH_ERROR_VERSION);
    EXPECT_EQ(host.def.struct_size, 0U);
    EXPECT_EQ(host.later, 0.0);
}

TEST(HostGrowth, SizesOfNoVersionAreRefusedByName) {
    HostScene scene;
    scene.step();
    hh_player_pose pose{};
    hh_hand_state hand{};
    const hh_event* events = nullptr;
    std::size_t count = 0;
    const hh_world* const world = scene.world.get();
    for (const std::size_t wrong :
         {std::size_t{0}, sizeof(hh_hand_state) - 1, std::size_t{1} << 20U}) {
        EXPECT_EQ(hh_player_hand_sized(world, scene.player, HH_LEFT, &hand, wrong),
                  HH_ERROR_VERSION);
        EXPECT_EQ(hh_world_player_poses_sized(world, &scene.player, 1, &pose, sizeof pose, wrong),
                  HH_ERROR_VERSION);
        EXPECT_EQ(hh_world_player_poses_sized(world, &scene.player, 1, &pose, wrong, sizeof hand),
                  HH_ERROR_VERSION);
    }
    for (const std::size_t wrong : {std::size_t{0}, sizeof(hh_event) - 1, sizeof(hh_event) + 1}) {
        EXPECT_EQ(hh_world_events_sized(world, &events, &count, wrong), HH_ERROR_VERSION);
        EXPECT_EQ(count, 0U);
    }
}

TEST(HostGrowth, SamplesWithoutTheirSizeAreRefusedAndNothingSteps) {
    HostScene scene;
    scene.step(3);
    std::array<hh_tracking_sample, 2> samples = {scene.sample(), scene.sample()};
    samples[1].time_s += 1e-3;
    for (const std::uint32_t wrong :
         {std::uint32_t{0}, static_cast<std::uint32_t>(sizeof(hh_tracking_sample) + 8)}) {
        samples[1].struct_size = wrong;
        const double before_s = scene.world.time_s();
        const hh::Status status =
            scene.world.step(k_step_s, hh::input(scene.player, {samples.data(), 2}));
        EXPECT_EQ(status.result(), HH_ERROR_VERSION);
        EXPECT_NE(status.text().find("struct_size"), std::string_view::npos);
        EXPECT_EQ(scene.world.time_s(), before_s);
    }
}

}  // namespace
}  // namespace handhold::host_growth_test
