#include "components/tuning.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "components/scaled_tuning.hpp"
#include "systems/host/tuning_json.hpp"
#include "tests/components/member_count.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::tuning_test {
namespace {

using test::member_count;
using test::Random;

std::vector<double> numbers_of(double field) { return {field}; }
std::vector<double> numbers_of(std::int32_t field) { return {static_cast<double>(field)}; }
std::vector<double> numbers_of(SupportFollow field) { return {static_cast<double>(field)}; }
std::vector<double> numbers_of(const Vec3& field) { return {field.x(), field.y(), field.z()}; }

std::vector<double> all_numbers(const Tuning& tuning) {
    std::vector<double> all;
    visit_tuning(tuning, [&all](const TuningInfo&, const auto& field) {
        for (const double number : numbers_of(field)) {
            all.push_back(number);
        }
    });
    return all;
}

TEST(Tuning, EveryDefaultLiesInItsRange) {
    const Tuning tuning;
    visit_tuning(tuning, [](const TuningInfo& info, const auto& field) {
        EXPECT_LT(info.low, info.high) << info.name;
        for (const double number : numbers_of(field)) {
            EXPECT_GE(number, info.low) << info.name;
            EXPECT_LE(number, info.high) << info.name;
        }
    });
}

TEST(Tuning, NamesAreUniqueAndDescribed) {
    const Tuning tuning;
    std::set<std::string> names;
    visit_tuning(tuning, [&names](const TuningInfo& info, const auto&) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_NE(std::string(info.name).find('.'), std::string::npos) << info.name;
        EXPECT_FALSE(std::string(info.what).empty()) << info.name;
    });
}

// Lengths, speeds, accelerations and forces of the player scale, the world's do not.
TEST(Tuning, ScaledTuningHasTheNumbersInThePlayersMetresTimesTheScale) {
    const Tuning tuning;
    const Tuning giant = scaled(tuning, 3.0);
    std::vector<std::vector<double>> before;
    visit_tuning(
        tuning, [&](const TuningInfo&, const auto& field) { before.push_back(numbers_of(field)); });
    std::size_t at = 0;
    std::set<std::string> scaling;
    visit_tuning(giant, [&](const TuningInfo& info, const auto& field) {
        const std::vector<double> now = numbers_of(field);
        for (std::size_t i = 0; i < now.size(); ++i) {
            EXPECT_EQ(now[i], before[at][i] * (info.scales ? 3.0 : 1.0)) << info.name;
        }
        ++at;
        if (info.scales) {
            scaling.insert(info.name);
        }
    });
    for (const char* const name :
         {"hand.max_arm_m", "hand.palm_center_m", "tracking.max_hand_speed_mps", "head.radius_m",
          "palm.tilt_cost_m_per_rad", "locomotion.thruster_mps2", "pull.force_n"}) {
        EXPECT_TRUE(scaling.contains(name)) << name;
    }
    for (const char* const name :
         {"contact.margin_m", "solver.tolerance_m", "tracking.lost_after_s", "hand.swing_lag_s",
          "pull.max_mass_kg", "palm.max_angle_rad", "thumb.penetration_cost"}) {
        EXPECT_FALSE(scaling.contains(name)) << name;
    }
}

TEST(Tuning, EveryMemberOfEveryGroupIsVisited) {
    // NewtonSettings has two groups of its own.
    constexpr std::size_t k_solver = member_count<SolverTuning>() - 1 +
                                     member_count<NewtonSettings>() - 2 +
                                     member_count<Regularisation>() + member_count<StepControl>();
    constexpr std::size_t k_members =
        member_count<TrackingTuning>() + member_count<HandTuning>() + member_count<HeadTuning>() +
        member_count<LocomotionTuning>() + member_count<PhaseTuning>() +
        member_count<ContactTuning>() + k_solver + member_count<ArmTuning>() +
        member_count<SpineTuning>() + member_count<AdditiveTuning>() + member_count<PalmTuning>() +
        member_count<FingerTuning>() + member_count<ThumbTuning>() +
        member_count<CalibrationTuning>() + member_count<PullTuning>();
    static_assert(member_count<Tuning>() == 15, "a new group belongs into the sum above");
    const Tuning tuning;
    std::set<const void*> fields;
    visit_tuning(tuning,
                 [&fields](const TuningInfo&, const auto& field) { fields.insert(&field); });
    EXPECT_EQ(fields.size(), k_members);
}

void set_random(double& field, const TuningInfo& info, Random& random) {
    field = random.between(info.low, info.high);
}
void set_random(Vec3& field, const TuningInfo& info, Random& random) {
    for (double& axis : field) {
        axis = random.between(info.low, info.high);
    }
}
void set_random(std::int32_t& field, const TuningInfo& info, Random& random) {
    field = static_cast<std::int32_t>(random.between(info.low, info.high));
}
void set_random(SupportFollow& field, const TuningInfo&, Random& random) {
    field = static_cast<SupportFollow>(static_cast<int>(random.between(0.0, 3.0)));
}

TEST(TuningJson, AnyTuningRoundTripsBitForBit) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        Tuning tuning;
        visit_tuning(tuning, [&random](const TuningInfo& info, auto& field) {
            set_random(field, info, random);
        });
        if (tuning.phases.kappa_light_kg >= tuning.phases.kappa_heavy_kg) {
            std::swap(tuning.phases.kappa_light_kg, tuning.phases.kappa_heavy_kg);
        }
        const Result<Tuning> read = parse_tuning(tuning_to_json(tuning), "round.json");
        ASSERT_TRUE(read.ok()) << read.error().message();
        EXPECT_EQ(all_numbers(read.value()), all_numbers(tuning)) << seed;
    }
}

TEST(TuningJson, MissingNumbersKeepTheirDefault) {
    const Result<Tuning> empty = parse_tuning("{}", "empty.json");
    ASSERT_TRUE(empty.ok());
    EXPECT_EQ(all_numbers(empty.value()), all_numbers(Tuning{}));
    const Result<Tuning> one = parse_tuning(R"({"hand": {"reach_m": 0.25}})", "one.json");
    ASSERT_TRUE(one.ok());
    Tuning expected;
    expected.hand.reach_m = 0.25;
    EXPECT_EQ(all_numbers(one.value()), all_numbers(expected));
}

TEST(TuningJson, EachKindOfMalformedFileIsRefusedWithItsPlace) {
    const std::vector<std::pair<const char*, const char*>> cases = {
        {R"({"hands": {}})", "/hands"},
        {R"({"hand": {"reach": 0.2}})", "/hand/reach"},
        {R"({"hand": 3})", "/hand"},
        {R"({"hand": null})", "/hand"},
        {R"({"hand": {"reach_m": "0.2"}})", "/hand/reach_m"},
        {R"({"hand": {"reach_m": null}})", "/hand/reach_m"},
        {R"({"hand": {"palm_center_m": 0.2}})", "/hand/palm_center_m"},
        {R"({"hand": {"palm_center_m": [0.0, 0.0]}})", "/hand/palm_center_m"},
        {R"({"hand": {"palm_center_m": [0.0, 0.0, 9.0]}})", "/hand/palm_center_m/2"},
        {R"({"solver": {"max_iterations": 2.5}})", "/solver/max_iterations"},
        {R"({"solver": {"max_iterations": 0}})", "/solver/max_iterations"},
        {R"({"locomotion": {"support_follow": 3}})", "/locomotion/support_follow"},
        {R"({"locomotion": {"support_follow": "yaw"}})", "/locomotion/support_follow"},
        {R"({"phases": {"kappa_light_kg": 2000.0}})", "/phases"},
        {R"({"phases": {"kappa_light_kg": 5.0, "kappa_heavy_kg": 5.0}})", "/phases"},
        {R"([1, 2])", ""},
    };
    for (const auto& [text, place] : cases) {
        const Result<Tuning> read = parse_tuning(text, "bad.json");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.error().file, "bad.json");
        EXPECT_EQ(read.error().place, place) << text << ": " << read.error().message();
        EXPECT_FALSE(read.error().expected.empty()) << text;
    }
}

TEST(TuningJson, InvalidJsonIsRefusedWithItsLine) {
    for (const char* const text :
         {"", "{", R"({"hand": {"reach_m": 0.2,}})", R"({"hand": {}, "hand": {}})"}) {
        const Result<Tuning> read = parse_tuning(text, "bad.json");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_FALSE(read.error().message().empty());
    }
}

TEST(TuningJson, NumbersJustOutsideTheirRangeAreRefused) {
    const Tuning defaults;
    visit_tuning(defaults, [](const TuningInfo& info, const auto& field) {
        const std::string name = info.name;
        const std::size_t dot = name.find('.');
        const bool is_whole = std::is_integral_v<std::remove_cvref_t<decltype(field)>> ||
                              std::is_enum_v<std::remove_cvref_t<decltype(field)>>;
        for (const double outside : {info.low - 1.0, info.high + 1.0}) {
            std::string number =
                is_whole ? std::to_string(static_cast<int>(outside)) : std::to_string(outside);
            if (numbers_of(field).size() == 3) {
                number = "[" + number + ", 0.0, 0.0]";
            }
            const std::string text = "{\"" + name.substr(0, dot) + "\": {\"" +
                                     name.substr(dot + 1) + "\": " + number + "}}";
            const Result<Tuning> read = parse_tuning(text, "range.json");
            ASSERT_FALSE(read.ok()) << text;
            const std::string pointer = "/" + name.substr(0, dot) + "/" + name.substr(dot + 1);
            EXPECT_EQ(read.error().place.rfind(pointer, 0), 0U) << read.error().message();
        }
    });
}

}  // namespace
}  // namespace handhold::tuning_test
