#include "engine/geometry/bvh_builder.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/geometry/closest_point.hpp"

namespace handhold {
namespace {

// Largest number of triangles in a leaf. A node whose triangles fit into two leaves is split into a
// full leaf and the rest.
constexpr std::uint32_t k_leaf = 4;
// From this depth on, nodes are split into halves with equally many triangles. This bounds the
// tree's depth and with it the stack of a query.
constexpr std::uint32_t k_planned_depth = 30;
// Padding of a box, relative to the mesh's size: four float roundings.
constexpr double k_padding = 0x1p-22;

// Cost of testing triangles: the number of groups of four, because four are tested at once.
std::uint32_t fours_of(std::uint32_t triangles) { return (triangles + k_leaf - 1) / k_leaf; }

}  // namespace

BvhBuilder::Box BvhBuilder::Box::none() {
    constexpr float k_far = std::numeric_limits<float>::infinity();
    return {splat4(k_far), splat4(-k_far)};
}

void BvhBuilder::Box::join(const Box& other) {
    low = lower(low, other.low);
    high = higher(high, other.high);
}

double BvhBuilder::Box::half_area() const {
    const auto side = [&](std::size_t axis) -> double {
        return static_cast<double>(high[axis]) - static_cast<double>(low[axis]);
    };
    return side(0) * side(1) + side(1) * side(2) + side(2) * side(0);
}

BvhBuilder::BvhBuilder(TriangleBvh& bvh, std::span<const Vec3> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles,
                       const TriangleBvh::Known& known)
    : bvh_(bvh),
      positions_(positions),
      triangles_(triangles),
      order_(known.order),
      normals_(known.normals) {}

// Collects the bounding boxes of all finite triangles, relative to the mesh's centre.
void BvhBuilder::gather() {
    std::vector<std::uint32_t> finite;
    finite.reserve(triangles_.size());
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const std::uint32_t t = order_.empty() ? i : order_[i];
        bool whole = true;
        for (const std::uint32_t index : triangles_[t]) {
            HH_CHECK(index < positions_.size(), "an index is out of range in triangle", t);
            whole = whole && is_finite(positions_[index]);
        }
        if (whole) {
            finite.push_back(t);
            for (const std::uint32_t index : triangles_[t]) {
                low = low.cwiseMin(positions_[index]);
                high = high.cwiseMax(positions_[index]);
            }
        }
    }
    if (finite.empty()) {
        return;
    }
    bvh_.origin_ = 0.5 * low + 0.5 * high;
    padding_ = static_cast<float>(k_padding * (high - low).maxCoeff());
    items_.reserve(finite.size());
    for (const std::uint32_t t : finite) {
        Item item = {Box::none()};
        for (const std::uint32_t index : triangles_[t]) {
            const Vec3 local = positions_[index] - bvh_.origin_;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto value = static_cast<float>(local[static_cast<Eigen::Index>(axis)]);
                item.box.low[axis] = std::min(item.box.low[axis], value - padding_);
                item.box.high[axis] = std::max(item.box.high[axis], value + padding_);
            }
        }
        item.set_triangle(t);
        items_.push_back(item);
    }
}

// If all boxes have the same middle along an axis, their bin along this axis means nothing.
Int4 BvhBuilder::bins_of(const Item& item, const Box& middles) {
    const Float4 width = middles.high - middles.low;
    const Float4 safe = width > splat4(0.0F) ? width : splat4(1.0F);
    const Float4 share = (item.box.middle() - middles.low) / safe;
    const Int4 bin = __builtin_convertvector(share * splat4(static_cast<float>(k_bins)), Int4);
    constexpr auto k_last = static_cast<std::int32_t>(k_bins - 1);
    const Int4 last = {k_last, k_last, k_last, k_last};
    return bin < last ? bin : last;
}

BvhBuilder::Split BvhBuilder::best_split_along(std::size_t axis, const Bins& bins,
                                               std::uint32_t all) {
    const auto& [boxes, counts] = bins;
    std::array<double, k_bins> upper_cost = {};  // cost of this bin and all above it
    Box upper = Box::none();
    std::uint32_t upper_count = 0;
    for (std::size_t bin = k_bins - 1; bin > 0; --bin) {
        upper.join(boxes[bin]);
        upper_count += counts[bin];
        upper_cost[bin] = upper_count > 0 ? upper.half_area() * fours_of(upper_count) : 0.0;
    }
    Split best;
    Box lower = Box::none();
    std::uint32_t lower_count = 0;
    for (std::uint32_t bin = 1; bin < k_bins; ++bin) {
        lower.join(boxes[bin - 1]);
        lower_count += counts[bin - 1];
        if (lower_count == 0 || lower_count == all) {
            continue;
        }
        const double cost = lower.half_area() * fours_of(lower_count) + upper_cost[bin];
        if (!best.found || cost < best.cost) {
            best = {axis, bin, cost, true};
        }
    }
    return best;
}

BvhBuilder::Split BvhBuilder::best_split(const Work& work, const Box& middles) const {
    std::array<Bins, 3> by_axis;
    for (Bins& bins : by_axis) {
        bins.boxes.fill(Box::none());
        bins.counts.fill(0);
    }
    for (std::uint32_t i = work.first; i < work.last; ++i) {
        const Int4 bin = bins_of(items_[i], middles);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(std::max(bin[axis], 0));
            by_axis[axis].boxes[at].join(items_[i].box);
            ++by_axis[axis].counts[at];
        }
    }
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(middles.high[axis] > middles.low[axis])) {
            continue;
        }
        const Split split = best_split_along(axis, by_axis[axis], work.last - work.first);
        if (split.found && (!best.found || split.cost < best.cost)) {
            best = split;
        }
    }
    return best;
}

// Partitions the items and returns the index of the upper side's first item.
std::uint32_t BvhBuilder::part(const Work& work, const Split& split, const Box& middles) {
    if (!order_.empty()) {  // all leaves are full, except perhaps the last one
        const std::uint32_t half = (work.last - work.first) / 2 / k_leaf * k_leaf;
        return work.first + std::max(half, k_leaf);
    }
    const auto first = items_.begin() + work.first;
    const auto last = items_.begin() + work.last;
    if (split.found && work.depth < k_planned_depth) {
        const auto middle = std::partition(first, last, [&](const Item& item) {
            return bins_of(item, middles)[split.axis] < static_cast<std::int32_t>(split.bin);
        });
        return static_cast<std::uint32_t>(middle - items_.begin());
    }
    // If there is no useful split, the tree is too deep, or two leaves suffice: splits by position
    // and index, into halves or into a full leaf and the rest.
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (middles.high[axis] - middles.low[axis] > middles.high[widest] - middles.low[widest]) {
            widest = axis;
        }
    }
    const std::uint32_t count = work.last - work.first;
    const std::uint32_t half = work.first + (count <= 2 * k_leaf ? k_leaf : count / 2);
    std::nth_element(first, items_.begin() + half, last, [&](const Item& a, const Item& b) {
        const float middle_a = a.box.middle()[widest];
        const float middle_b = b.box.middle()[widest];
        return middle_a < middle_b || (middle_a == middle_b && a.triangle() < b.triangle());
    });
    return half;
}

void BvhBuilder::make_leaf(const Work& work) {
    std::sort(items_.begin() + work.first, items_.begin() + work.last,
              [](const Item& a, const Item& b) { return a.triangle() < b.triangle(); });
    pairs_[work.pair].first = work.first;
    pairs_[work.pair].count = work.last - work.first;
}

// Stores the leaves' triangles. Each leaf has four slots; unused slots repeat its last triangle.
void BvhBuilder::fill_leaves() {
    std::vector<std::uint32_t> leaves;
    leaves.reserve(pairs_.size() / 2 + 1);
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
        if (pairs_[i].count > 0) {
            leaves.push_back(i);
        }
    }
    std::sort(leaves.begin(), leaves.end(),
              [&](std::uint32_t a, std::uint32_t b) { return pairs_[a].first < pairs_[b].first; });
    bvh_.slots_.reserve(k_leaf * leaves.size());
    bvh_.numbers_.reserve(k_leaf * leaves.size());
    bvh_.fours_.reserve(leaves.size());
    for (const std::uint32_t leaf : leaves) {
        Pair& pair = pairs_[leaf];
        const std::uint32_t first_item = pair.first;
        pair.first = static_cast<std::uint32_t>(bvh_.slots_.size());
        for (std::uint32_t i = 0; i < k_leaf; ++i) {
            const Item& item = items_[first_item + std::min(i, pair.count - 1)];
            bvh_.slots_.push_back(copy_corners(item.triangle()));
            bvh_.numbers_.push_back(item.triangle());
        }
        add_four(pair.first);
    }
}

// Copies a triangle's corners in leaf order, so that they are near in memory.
std::array<std::uint32_t, 3> BvhBuilder::copy_corners(std::uint32_t triangle) {
    constexpr std::uint32_t k_not_copied = std::numeric_limits<std::uint32_t>::max();
    if (copied_.empty()) {
        copied_.resize(positions_.size(), k_not_copied);
        bvh_.positions_.reserve(positions_.size());
    }
    std::array<std::uint32_t, 3> slot = {};
    for (std::size_t i = 0; i < 3; ++i) {
        std::uint32_t& place = copied_[triangles_[triangle][i]];
        if (place == k_not_copied) {
            place = static_cast<std::uint32_t>(bvh_.positions_.size());
            bvh_.positions_.push_back(positions_[triangles_[triangle][i]]);
        }
        slot[i] = place;
    }
    return slot;
}

Vec3 BvhBuilder::normal_of(std::uint32_t slot, const Corners& corners) const {
    if (!normals_.empty()) {
        return normals_[bvh_.numbers_[slot]];
    }
    // Smallest area, in units of the longest edge squared. In thinner triangles the normal's
    // rounding error exceeds that of a float.
    constexpr double k_least_area = 1e-8;
    const Vec3 area = area_vector(corners);
    const double length = area.norm();
    const double longest2 =
        std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                  (corners[0] - corners[2]).squaredNorm()});
    return length > k_least_area * longest2 ? Vec3(area / length) : Vec3(Vec3::Zero());
}

void BvhBuilder::add_four(std::uint32_t first_slot) {
    Triangles4 four;
    for (std::uint32_t i = 0; i < k_leaf; ++i) {
        const Corners corners = bvh_.corners_at(first_slot + i);
        const auto put = [i](std::array<Float4, 3>& to, const Vec3& from) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                to[axis][i] = static_cast<float>(from[static_cast<Eigen::Index>(axis)]);
            }
        };
        for (std::size_t c = 0; c < 3; ++c) {
            put(four.corner[c], corners[c] - bvh_.origin_);
        }
        put(four.normal, normal_of(first_slot + i, corners));
    }
    bvh_.fours_.push_back(four);
}

void BvhBuilder::divide() {
    pairs_.reserve(items_.size());
    pairs_.emplace_back();
    std::vector<Work> open = {{0, 0, static_cast<std::uint32_t>(items_.size()), 0}};
    while (!open.empty()) {
        const Work work = open.back();
        open.pop_back();
        const std::uint32_t count = work.last - work.first;
        Box box = Box::none();
        Box middles = Box::none();
        for (std::uint32_t i = work.first; i < work.last; ++i) {
            box.join(items_[i].box);
            const Float4 middle = items_[i].box.middle();
            middles.join({middle, middle});
        }
        pairs_[work.pair].box = box;
        if (count <= k_leaf) {
            make_leaf(work);
            continue;
        }
        const bool is_searched = order_.empty() && count > 2 * k_leaf;
        const Split split = is_searched ? best_split(work, middles) : Split{};
        const std::uint32_t middle = part(work, split, middles);
        const auto child = static_cast<std::uint32_t>(pairs_.size());
        pairs_[work.pair].first = child;
        pairs_.resize(child + 2);
        open.push_back({child + 1, middle, work.last, work.depth + 1});
        open.push_back({child, work.first, middle, work.depth + 1});
    }
}

// The up to four descendants that replace a binary node's children, in tree order. Opens the
// largest boxes first.
std::vector<std::uint32_t> BvhBuilder::four_below(std::uint32_t pair) const {
    std::vector<std::uint32_t> below;
    below.reserve(4);
    below.push_back(pair);
    while (below.size() < 4) {
        auto widest = below.end();
        for (auto it = below.begin(); it != below.end(); ++it) {
            const bool is_inner = pairs_[*it].count == 0;
            if (is_inner && (widest == below.end() ||
                             pairs_[*it].box.half_area() > pairs_[*widest].box.half_area())) {
                widest = it;
            }
        }
        if (widest == below.end()) {
            break;
        }
        const std::uint32_t first = pairs_[*widest].first;
        *widest = first;
        below.insert(widest + 1, first + 1);
    }
    return below;
}

void BvhBuilder::make_nodes() {
    struct Open {
        std::uint32_t pair;
        std::uint32_t node;
    };
    const Box none = Box::none();
    std::vector<Open> open = {{0, 0}};
    bvh_.nodes_.emplace_back();
    while (!open.empty()) {
        const auto [pair, place] = open.back();
        open.pop_back();
        const std::vector<std::uint32_t> below = four_below(pair);
        TriangleBvh::Node node;
        for (std::size_t i = 0; i < 4; ++i) {
            const Box& box = i < below.size() ? pairs_[below[i]].box : none;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                node.box.low[axis][i] = box.low[axis];
                node.box.high[axis][i] = box.high[axis];
            }
        }
        for (std::size_t i = 0; i < below.size(); ++i) {
            const Pair& child = pairs_[below[i]];
            node.child[i] = {child.first, child.count};
            if (child.count == 0) {
                node.child[i].place = static_cast<std::uint32_t>(bvh_.nodes_.size());
                bvh_.nodes_.emplace_back();
                open.push_back({below[i], node.child[i].place});
            }
        }
        bvh_.nodes_[place] = node;
    }
}

void BvhBuilder::build() {
    gather();
    if (items_.empty()) {
        return;
    }
    divide();
    fill_leaves();
    bvh_.triangle_count_ = items_.size();
    std::vector<Item>().swap(items_);  // frees 32 MB for a million triangles
    make_nodes();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        bvh_.low_[at] = static_cast<double>(pairs_[0].box.low[axis]);
        bvh_.high_[at] = static_cast<double>(pairs_[0].box.high[axis]);
    }
    std::vector<Pair>().swap(pairs_);
    bvh_.nodes_.shrink_to_fit();
    bvh_.positions_.shrink_to_fit();
}

}  // namespace handhold
