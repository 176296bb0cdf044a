#include "engine/core/hash.hpp"

#include <cstdint>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "engine/ecs/entity.hpp"

namespace handhold::hash_test {
namespace {

// First published outputs of SplitMix64 for the seed 1234567.
TEST(Hash, Mix64IsTheFinaliserOfSplitMix64) {
    constexpr std::uint64_t k_step = 0x9e3779b97f4a7c15ULL;
    std::uint64_t state = 1234567;
    for (const std::uint64_t expected :
         {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
          4593380528125082431ULL, 16408922859458223821ULL}) {
        state += k_step;
        EXPECT_EQ(mix64(state), expected);
    }
}

// Test vectors by the FNV authors.
TEST(Hash, HashTextIsFnv1aOf64Bits) {
    EXPECT_EQ(hash_text(""), 0xcbf29ce484222325ULL);
    EXPECT_EQ(hash_text("a"), 0xaf63dc4c8601ec8cULL);
    EXPECT_EQ(hash_text("foobar"), 0x85944171f73967e8ULL);
}

TEST(Hash, HashTextTreatsBytesAsUnsigned) {
    constexpr std::uint64_t k_basis = 0xcbf29ce484222325ULL;
    constexpr std::uint64_t k_prime = 0x100000001b3ULL;
    EXPECT_EQ(hash_text("\xff"), (k_basis ^ 0xffU) * k_prime);
}

TEST(Hash, StreamDistinguishesOrderLengthAndSignOfZero) {
    const auto hash = [](std::initializer_list<double> values) {
        HashStream stream;
        for (const double value : values) {
            stream.add(value);
        }
        return stream.value();
    };
    const std::set<std::uint64_t> hashes = {hash({}),        hash({0.0}),     hash({-0.0}),
                                            hash({0, 0}),    hash({1, 2}),    hash({2, 1}),
                                            hash({1, 2, 0}), hash({0, 1, 2}), hash({1})};
    EXPECT_EQ(hashes.size(), 9U);
    EXPECT_EQ(hash({1, 2}), hash({1, 2}));
}

TEST(Hash, StreamHashesBitsOfNaN) {
    HashStream quiet;
    HashStream negative;
    quiet.add(std::numeric_limits<double>::quiet_NaN());
    negative.add(-std::numeric_limits<double>::quiet_NaN());
    EXPECT_NE(quiet.value(), negative.value());
}

TEST(Hash, PersistentIdDependsOnNameAndIsNeverNone) {
    EXPECT_EQ(persistent_id_from_name("crate"), persistent_id_from_name("crate"));
    EXPECT_NE(persistent_id_from_name("crate"), persistent_id_from_name("door"));
    EXPECT_NE(persistent_id_from_name(""), PersistentId{});
}

}  // namespace
}  // namespace handhold::hash_test
