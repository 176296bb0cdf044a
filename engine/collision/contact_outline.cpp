// Bullet's persistent manifold is not used: it keeps four points, chosen by order of arrival, and
// merges points within its breaking threshold (2 cm). The corners of a face that rests on many
// triangles would be lost.
#include "engine/collision/contact_outline.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace handhold {
namespace {

// Contacts that no comparison of their doubles tells apart are sorted by part, then by their bits:
// 0.0 equals -0.0, but the state would not.
bool position_less(const NearContact& a, const NearContact& b) {
    const auto key = [](const NearContact& c) {
        return std::array<double, 10>{c.point_b_ns.x(), c.point_b_ns.y(), c.point_b_ns.z(),
                                      c.separation_m,   c.normal_ns.x(),  c.normal_ns.y(),
                                      c.normal_ns.z(),  c.point_a_ns.x(), c.point_a_ns.y(),
                                      c.point_a_ns.z()};
    };
    const auto key_a = key(a);
    const auto key_b = key(b);
    if (key_a != key_b) {
        return key_a < key_b;
    }
    using Bits = std::array<std::uint64_t, 10>;
    return a.part != b.part ? a.part < b.part
                            : std::bit_cast<Bits>(key_a) < std::bit_cast<Bits>(key_b);
}

constexpr double k_same_normal_cosine = 1.0 - 1e-7;

// Signed distance of `point` from the line through `from` and `to`. Positive: to the left of the
// line, if the normal points at the viewer.
double height_over_line(const NearContact& from, const NearContact& to, const NearContact& point) {
    const Vec3 line = to.point_b_ns - from.point_b_ns;
    const double length = line.norm();
    return length > 0.0
               ? from.normal_ns.dot(line.cross(point.point_b_ns - from.point_b_ns)) / length
               : 0.0;
}

double distance_between(const NearContact& a, const NearContact& b) {
    return (a.point_b_ns - b.point_b_ns).norm();
}

// Gift wrapping step: the next corner of the outline after `from`, counter-clockwise. No contact
// lies to the right of the line from `from` to this corner. Of collinear contacts, returns the
// farthest.
const NearContact& next_corner(std::span<const NearContact> group, const NearContact& from) {
    const NearContact* best = &from;
    for (const NearContact& other : group) {
        if (distance_between(from, other) <= k_same_place_m) {
            continue;
        }
        const double height = height_over_line(from, *best, other);
        const bool farther = distance_between(from, other) > distance_between(from, *best);
        if (best == &from || height < -k_same_place_m || (height <= k_same_place_m && farther)) {
            best = &other;
        }
    }
    return *best;
}

// Removes the flattest corner until 8 are left. Of equally flat corners, removes the first: a
// regular polygon loses every other corner.
void limit_corners(std::vector<NearContact>& outline, std::size_t first) {
    constexpr std::size_t k_max_group = 8;
    constexpr double k_equal_m = 1e-9;
    while (outline.size() - first > k_max_group) {
        const std::size_t count = outline.size() - first;
        std::size_t flattest = 0;
        double lowest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < count; ++i) {
            const double height =
                std::abs(height_over_line(outline[first + (i + count - 1) % count],
                                          outline[first + (i + 1) % count], outline[first + i]));
            if (height < lowest - k_equal_m) {
                lowest = height;
                flattest = i;
            }
        }
        outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(first + flattest));
    }
}

// Appends the outline of one group with equal normals, by gift wrapping (Jarvis 1973), and its
// deepest point.
void add_outline(std::span<const NearContact> group, std::vector<NearContact>& result) {
    const Vec3 along = group.front().normal_ns.unitOrthogonal();
    const auto deeper = [](const NearContact& a, const NearContact& b) {
        return a.separation_m < b.separation_m;
    };
    const NearContact& deepest = *std::min_element(group.begin(), group.end(), deeper);
    const NearContact& start = *std::min_element(
        group.begin(), group.end(), [&](const NearContact& a, const NearContact& b) {
            return along.dot(a.point_b_ns) < along.dot(b.point_b_ns);
        });
    const std::size_t first = result.size();
    const NearContact* corner = &start;
    for (std::size_t i = 0; i < group.size(); ++i) {
        result.push_back(*corner);
        corner = &next_corner(group, *corner);
        if (distance_between(*corner, start) <= k_same_place_m) {
            break;
        }
    }
    limit_corners(result, first);
    const auto outline = std::span<const NearContact>(result).subspan(first);
    const double lowest = std::min_element(outline.begin(), outline.end(), deeper)->separation_m;
    if (deepest.separation_m < lowest - k_same_place_m) {
        result.push_back(deepest);
    }
}

// Moves the contacts that satisfy `belongs` to the front and returns how many there are. Swaps the
// first that does not with the last that does until they meet. Not std::partition, whose order is
// unspecified: the first contact of the rest is the next group's normal.
template <class Belongs>
std::size_t move_to_front(std::span<NearContact> contacts, const Belongs& belongs) {
    std::size_t first = 0;
    std::size_t last = contacts.size();
    while (true) {
        while (first < last && belongs(contacts[first])) {
            ++first;
        }
        while (first < last && !belongs(contacts[last - 1])) {
            --last;
        }
        if (first == last) {
            return first;
        }
        std::swap(contacts[first++], contacts[--last]);
    }
}

}  // namespace

void reduce_contacts(std::vector<NearContact>& contacts, std::vector<NearContact>& scratch) {
    std::sort(contacts.begin(), contacts.end(), position_less);
    scratch.clear();
    // Each group is the contacts whose normals are near that of the first contact left. The input
    // is sorted by position, so the result does not depend on the order of insertion.
    std::span<NearContact> remaining = contacts;
    while (!remaining.empty()) {
        const Vec3 normal = remaining.front().normal_ns;
        const std::size_t count = move_to_front(remaining, [&](const NearContact& c) {
            return c.normal_ns.dot(normal) > k_same_normal_cosine;
        });
        add_outline(remaining.first(count), scratch);
        remaining = remaining.subspan(count);
    }
    contacts.swap(scratch);
    std::sort(contacts.begin(), contacts.end(), position_less);
}

}  // namespace handhold
