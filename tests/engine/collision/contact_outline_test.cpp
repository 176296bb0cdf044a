#include "engine/collision/contact_outline.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"

namespace handhold::contact_outline_test {
namespace {

using test::Random;

// An index below `count`.
std::size_t pick(Random& random, std::size_t count) { return random.engine()() % count; }

// Contacts of four faces, whose normals differ, on a grid: some in one place, some equally deep.
std::vector<NearContact> make_contacts(Random& random) {
    const std::array<Vec3, 4> normals = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX(),
                                         Vec3(0.6, 0.8, 0.0)};
    std::vector<NearContact> contacts;
    for (int i = 0; i < 60; ++i) {
        NearContact contact;
        contact.normal_ns = normals[pick(random, normals.size())];
        for (int axis = 0; axis < 3; ++axis) {
            contact.point_b_ns[axis] = 0.1 * static_cast<double>(pick(random, 5));
        }
        contact.separation_m = -0.01 * static_cast<double>(pick(random, 3));
        contact.point_a_ns = contact.point_b_ns + contact.separation_m * contact.normal_ns;
        contact.part = static_cast<std::uint32_t>(pick(random, 4));
        contacts.push_back(contact);
    }
    return contacts;
}

// All bits of a contact, without padding.
std::array<std::uint64_t, 11> bits_of(const NearContact& contact) {
    std::array<std::uint64_t, 11> bits{};
    std::size_t at = 0;
    for (const Vec3& vector : {contact.point_a_ns, contact.point_b_ns, contact.normal_ns}) {
        for (const double value : {vector.x(), vector.y(), vector.z()}) {
            bits[at++] = std::bit_cast<std::uint64_t>(value);
        }
    }
    bits[at++] = std::bit_cast<std::uint64_t>(contact.separation_m);
    bits[at] = contact.part;
    return bits;
}

std::vector<std::array<std::uint64_t, 11>> reduced_bits(std::vector<NearContact> contacts) {
    std::vector<NearContact> scratch;
    reduce_contacts(contacts, scratch);
    std::vector<std::array<std::uint64_t, 11>> bits;
    for (const NearContact& contact : contacts) {
        bits.push_back(bits_of(contact));
    }
    return bits;
}

void shuffle(std::vector<NearContact>& contacts, Random& random) {
    for (std::size_t i = contacts.size() - 1; i > 0; --i) {
        std::swap(contacts[i], contacts[pick(random, i + 1)]);
    }
}

// What std::sort and std::partition leave in an unspecified order must not reach the state: the
// corners that remain are the same, bit for bit, whatever order the contacts come in.
TEST(ReduceContacts, DependsOnNoOrderOfItsInput) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        std::vector<NearContact> contacts = make_contacts(random);
        const auto expected = reduced_bits(contacts);
        ASSERT_LT(expected.size(), contacts.size());
        for (int turn = 0; turn < 5; ++turn) {
            shuffle(contacts, random);
            ASSERT_EQ(reduced_bits(contacts), expected) << "seed " << seed;
        }
    }
}

// Two parts of a compound may touch in the same point, and a zero may have either sign.
TEST(ReduceContacts, TellsTiedPositionsApart) {
    std::vector<NearContact> contacts;
    for (std::uint32_t part = 0; part < 8; ++part) {
        for (const double zero : {0.0, -0.0}) {
            for (const double x : {0.0, 0.1}) {
                NearContact contact;
                contact.point_a_ns = contact.point_b_ns = Vec3(x, zero, zero);
                contact.part = part;
                contacts.push_back(contact);
            }
        }
    }
    const auto expected = reduced_bits(contacts);
    ASSERT_EQ(expected.size(), 2U);
    EXPECT_EQ(expected[0].back(), 0U);  // the least part
    EXPECT_EQ(expected[1].back(), 0U);
    Random random(1);
    for (int turn = 0; turn < 200; ++turn) {
        shuffle(contacts, random);
        ASSERT_EQ(reduced_bits(contacts), expected) << "turn " << turn;
    }
}

}  // namespace
}  // namespace handhold::contact_outline_test
