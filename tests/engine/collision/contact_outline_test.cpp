#include "engine/collision/contact_outline.hpp"

#include <array>
#include <cstddef>
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
        contacts.push_back(contact);
    }
    return contacts;
}

// What std::partition leaves in an unspecified order must not reach the state: the corners that
// remain are the same, bit for bit, whatever order the contacts come in.
TEST(ReduceContacts, DependsOnNoOrderOfItsInput) {
    std::vector<NearContact> scratch;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        const std::vector<NearContact> contacts = make_contacts(random);
        std::vector<NearContact> expected = contacts;
        reduce_contacts(expected, scratch);
        ASSERT_LT(expected.size(), contacts.size());
        for (int turn = 0; turn < 5; ++turn) {
            std::vector<NearContact> shuffled = contacts;
            for (std::size_t i = shuffled.size() - 1; i > 0; --i) {
                std::swap(shuffled[i], shuffled[pick(random, i + 1)]);
            }
            reduce_contacts(shuffled, scratch);
            ASSERT_EQ(shuffled.size(), expected.size()) << "seed " << seed;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                ASSERT_EQ(shuffled[i].point_a_ns, expected[i].point_a_ns) << "seed " << seed;
                ASSERT_EQ(shuffled[i].point_b_ns, expected[i].point_b_ns) << "seed " << seed;
                ASSERT_EQ(shuffled[i].normal_ns, expected[i].normal_ns) << "seed " << seed;
                ASSERT_EQ(shuffled[i].separation_m, expected[i].separation_m) << "seed " << seed;
            }
        }
    }
}

}  // namespace
}  // namespace handhold::contact_outline_test
