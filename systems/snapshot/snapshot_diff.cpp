#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

#include "systems/snapshot/snapshot.hpp"
#include "systems/snapshot/snapshot_fields.hpp"
#include "systems/snapshot/snapshot_schema.hpp"

namespace handhold {
namespace {

enum class LeafKind : std::uint8_t { number, whole, negative, entity };

// One leaf value of a component.
struct Leaf {
    LeafKind kind = LeafKind::whole;
    std::uint64_t bits = 0;  // entity: its persistent id; 0 for null and for stale handles
    friend bool operator==(const Leaf&, const Leaf&) = default;
};

template <typename T>
Leaf leaf_of(const World& world, const T& value) {
    if constexpr (std::is_same_v<T, Entity>) {
        const PersistentId* const id = world.persistent_id.find(value);
        return {LeafKind::entity, id != nullptr ? id->value : 0};
    } else if constexpr (std::is_same_v<T, ShapeId>) {
        return {LeafKind::whole, value.index};
    } else if constexpr (std::is_same_v<T, double>) {
        return {LeafKind::number, std::bit_cast<std::uint64_t>(value)};
    } else if constexpr (std::is_enum_v<T> || std::is_unsigned_v<T>) {
        return {LeafKind::whole, static_cast<std::uint64_t>(value)};
    } else {
        const auto wide = static_cast<std::int64_t>(value);
        return {wide < 0 ? LeafKind::negative : LeafKind::whole, static_cast<std::uint64_t>(wide)};
    }
}

// Collects an element's leaf values in walk order.
class LeafList : public FieldVisitor {
  public:
    LeafList(const World& world, std::vector<Leaf>& leaves) : world_(world), leaves_(leaves) {}
    template <typename T>
    void leaf(const T& value) {
        leaves_.push_back(leaf_of(world_, value));
    }

  private:
    const World& world_;
    std::vector<Leaf>& leaves_;
};

class WorldDiff {
  public:
    WorldDiff(const World& a, const World& b, const WorldDiffSettings& settings)
        : a_(a), b_(b), settings_(settings) {}

    std::vector<std::string> find() {
        compare("", [](const World& world, auto& visitor) { walk_globals(world, visitor); });
        const auto compare_members = [this](const char* name, auto member) {
            compare_columns(name, a_.*member, b_.*member);
        };
        if (settings_.simulated_only) {
            visit_simulated_members(compare_members);
        } else {
            visit_column_members(compare_members);
        }
        return std::move(found_);
    }

  private:
    // Compares the fields that walk(world, visitor) visits in both worlds.
    template <typename Walk>
    void compare(const std::string& where, Walk&& walk) {
        b_leaves_.clear();
        LeafList list(b_, b_leaves_);
        walk(b_, list);
        FieldComparison comparison(*this, where);
        walk(a_, comparison);
    }

    template <typename T>
    void compare_columns(const std::string& name, const Column<T>& a, const Column<T>& b) {
        for (std::size_t index = 0; index < a.size() && !is_full(); ++index) {
            const PersistentId id = id_of(a_, a.owners()[index]);
            const std::string where = name + "[" + name_of(id) + "]";
            const T* const other = b.find(find_by_id(b_, id));
            if (other == nullptr) {
                add(where + ": only in a");
                continue;
            }
            compare(where + ".", [&](const World& world, auto& visitor) {
                walk_component(&world == &a_ ? a.elements()[index] : *other, visitor);
            });
        }
        for (std::size_t index = 0; index < b.size() && !is_full(); ++index) {
            const PersistentId id = id_of(b_, b.owners()[index]);
            if (!a.contains(find_by_id(a_, id))) {
                add(name + "[" + name_of(id) + "]: only in b");
            }
        }
    }

    // Walks over a's fields; b's are in b_leaves_.
    class FieldComparison : public PathVisitor {
      public:
        FieldComparison(WorldDiff& diff, const std::string& where) : diff_(diff), where_(where) {}
        template <typename T>
        void leaf(const T& value) {
            if (next_ == diff_.b_leaves_.size()) {
                return;  // a longer list: its length was compared before
            }
            const Leaf a = leaf_of(diff_.a_, value);
            const Leaf& b = diff_.b_leaves_[next_++];
            if (a != b && !diff_.is_full()) {
                diff_.add(where_ + path() + ": a " + diff_.text(a) + ", b " + diff_.text(b));
            }
        }

      private:
        WorldDiff& diff_;
        const std::string& where_;
        std::size_t next_ = 0;
    };

    static PersistentId id_of(const World& world, Entity entity) {
        const PersistentId* const id = world.persistent_id.find(entity);
        return id != nullptr ? *id : PersistentId{};
    }
    std::string name_of(PersistentId id) const {
        const auto named = std::find_if(
            settings_.names.begin(), settings_.names.end(),
            [id](const std::string& name) { return persistent_id_from_name(name) == id; });
        return named != settings_.names.end() ? *named : text_of(id);
    }
    std::string text(const Leaf& leaf) const {
        switch (leaf.kind) {
            case LeafKind::number: {
                char digits[32];  // shortest text that parses back to the same number
                const auto end =
                    std::to_chars(digits, digits + sizeof digits, std::bit_cast<double>(leaf.bits));
                return {digits, end.ptr};
            }
            case LeafKind::whole:
                return std::to_string(leaf.bits);
            case LeafKind::negative:
                return std::to_string(static_cast<std::int64_t>(leaf.bits));
            case LeafKind::entity:
                break;
        }
        return leaf.bits == 0 ? "none" : name_of({leaf.bits});
    }
    bool is_full() const { return found_.size() >= settings_.limit; }
    void add(std::string difference) {
        if (!is_full()) {
            found_.push_back(std::move(difference));
        }
    }

    const World& a_;
    const World& b_;
    const WorldDiffSettings& settings_;
    std::vector<std::string> found_;
    std::vector<Leaf> b_leaves_;
};

}  // namespace

std::vector<std::string> diff_worlds(const World& a, const World& b,
                                     const WorldDiffSettings& settings) {
    return WorldDiff(a, b, settings).find();
}

}  // namespace handhold
