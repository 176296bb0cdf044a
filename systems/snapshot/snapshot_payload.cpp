#include "systems/snapshot/snapshot_payload.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "systems/snapshot/snapshot_fields.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_owner_bytes = 8;
// Larger numbers could overflow in products of squares, and are no valid length or time.
constexpr double k_largest_number = 1e18;
constexpr double k_unit_tolerance = 1e-3;  // same as in is_valid(Pose)

// --- Saving --------------------------------------------------------------------------------------

// Passes a leaf's value to put(), as one or two unsigned numbers of the same size in bytes.
template <typename T, typename Put>
void encode_leaf(const T& value, Put&& put) {
    if constexpr (std::is_same_v<T, Entity>) {
        put(value.slot);
        put(value.generation);
    } else if constexpr (std::is_same_v<T, ShapeId>) {
        put(value.index);
    } else if constexpr (std::is_same_v<T, double>) {
        put(std::bit_cast<std::uint64_t>(value));
    } else if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
        put(static_cast<std::uint8_t>(value));
    } else {
        put(static_cast<std::make_unsigned_t<T>>(value));
    }
}

class ByteCounter : public FieldVisitor {
  public:
    template <typename T>
    void leaf(const T& value) {
        encode_leaf(value, [this](auto number) { bytes_ += sizeof number; });
    }
    void note_list() { has_list_ = true; }
    std::size_t bytes() const { return bytes_; }
    bool has_list() const { return has_list_; }

  private:
    std::size_t bytes_ = 0;
    bool has_list_ = false;
};

// Bytes of one element's fields with empty lists. Without lists, all elements of a column have as
// many.
template <typename Component>
const ByteCounter& row_counter() {
    static const ByteCounter k_counter = [] {
        ByteCounter counter;
        walk_component(Component{}, counter);
        return counter;
    }();
    return k_counter;
}

template <typename Component>
std::size_t rows_bytes(std::span<const Component> rows) {
    if (!row_counter<Component>().has_list()) {
        return rows.size() * row_counter<Component>().bytes();
    }
    ByteCounter counter;
    for (const Component& element : rows) {
        walk_component(element, counter);
    }
    return counter.bytes();
}

template <typename T>
using ComponentOf = std::remove_cvref_t<decltype(std::declval<T>().elements()[0])>;

class ByteWriter : public FieldVisitor {
  public:
    explicit ByteWriter(std::byte* at) : at_(at) {}

    template <typename T>
    void put(T number) {
        store_little(number, at_);
        at_ += sizeof number;
    }
    void put_list(const std::vector<std::uint32_t>& numbers) {
        put(static_cast<std::uint32_t>(numbers.size()));
        for (const std::uint32_t number : numbers) {
            put(number);
        }
    }
    template <typename T>
    void leaf(const T& value) {
        encode_leaf(value, [this](auto number) { this->put(number); });
    }
    std::byte* at() const { return at_; }

  private:
    std::byte* at_;
};

// --- Restoring -----------------------------------------------------------------------------------

// Reads the payload. Keeps the first invalid value as the error; everything after it reads as zero.
class ByteReader : public PathVisitor {
  public:
    ByteReader(std::span<const std::byte> bytes, std::size_t begin, std::size_t end)
        : bytes_(bytes), at_(begin), end_(end) {}

    void read_world(World& world) {
        read_pool(world.entities);
        generations_ = &world.entities.generations();
        walk_globals(world, *this);
        visit_columns(world, [&](const char* name, auto& column) {
            enter(name);
            read_column(world.entities, column);
            leave();
        });
        if (at_ != end_) {
            refuse("the end of the columns, found " + std::to_string(end_ - at_) + " bytes more");
        }
    }
    const std::optional<FileError>& error() const { return error_; }

    // The walk passes const references, but to elements of the world under construction, which are
    // filled here.
    template <typename T>
    void leaf(const T& place) {
        T& value = const_cast<T&>(place);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
        if constexpr (std::is_same_v<T, Entity>) {
            value = read_handle();
        } else if constexpr (std::is_same_v<T, ShapeId>) {
            value.index = number<std::uint32_t>();
        } else if constexpr (std::is_same_v<T, double>) {
            value = read_double();
        } else if constexpr (std::is_same_v<T, bool>) {
            value = read_choice(2) != 0;
        } else if constexpr (std::is_enum_v<T>) {
            static_assert(k_value_count<T> > 0,
                          "add the enum's value count to components/fields.hpp");
            value = static_cast<T>(read_choice(k_value_count<T>));
        } else {
            value = static_cast<T>(number<std::make_unsigned_t<T>>());
        }
    }
    void finish(const Quat& q) {
        if (!(std::abs(q.norm() - 1.0) <= k_unit_tolerance)) {
            refuse("a rotation of length 1, found one of length " + std::to_string(q.norm()));
        }
    }

  private:
    void refuse(const std::string& expected) {
        if (!error_) {
            const std::string where = path();
            error_ = FileError{"snapshot",
                               "byte " + std::to_string(at_) + (where.empty() ? "" : ": " + where),
                               "expected " + expected};
        }
    }
    std::size_t left() const { return end_ - at_; }

    template <typename T>
    T number() {
        if (error_ || left() < sizeof(T)) {
            refuse(std::to_string(sizeof(T)) + " bytes more, found " + std::to_string(left()));
            return 0;
        }
        const T value = load_little<T>(bytes_.data() + at_);
        at_ += sizeof(T);
        return value;
    }
    // Reads a count of elements that take at least `bytes_each` bytes each.
    std::uint32_t count_of(std::size_t bytes_each, const char* what) {
        const auto count = number<std::uint32_t>();
        if (count > left() / bytes_each) {
            refuse("at most " + std::to_string(left() / bytes_each) + " " + what +
                   ", as many as the bytes left can hold, found " + std::to_string(count));
            return 0;
        }
        return count;
    }
    double read_double() {
        const auto value = std::bit_cast<double>(number<std::uint64_t>());
        if (!(std::abs(value) <= k_largest_number)) {
            refuse("a finite number within 1e18, found " + std::to_string(value));
            return 0.0;
        }
        return value;
    }
    std::uint8_t read_choice(std::uint32_t count) {
        const auto value = number<std::uint8_t>();
        if (value >= count) {
            refuse("a value below " + std::to_string(count) + ", found " + std::to_string(value));
            return 0;
        }
        return value;
    }
    // Handles that are null, alive or stale are valid. A handle of an entity that never existed is
    // not: it could match a future entity, once its slot was reused often enough.
    Entity read_handle() {
        const auto slot = number<std::uint32_t>();
        const auto generation = number<std::uint32_t>();
        const bool is_null_handle = slot == 0 && generation == 0;
        const bool has_been =
            generation != 0 && slot < generations_->size() && generation <= (*generations_)[slot];
        if (!is_null_handle && !has_been) {
            refuse("a handle of an entity that exists or existed, found slot " +
                   std::to_string(slot) + ", generation " + std::to_string(generation));
            return k_no_entity;
        }
        return {slot, generation};
    }

    std::vector<std::uint32_t> read_list(const char* what) {
        std::vector<std::uint32_t> numbers(count_of(sizeof(std::uint32_t), what));
        for (std::uint32_t& value : numbers) {
            value = number<std::uint32_t>();
        }
        return numbers;
    }
    void read_pool(EntityPool& pool) {
        enter("entities");
        std::vector<std::uint32_t> generations = read_list("slots");
        std::vector<std::uint32_t> free_slots = read_list("free slots");
        std::vector<std::uint8_t> is_free(generations.size(), 0);
        for (const std::uint32_t slot : free_slots) {
            if (slot >= is_free.size() || is_free[slot] != 0) {
                refuse("slots that exist, each free once, found " + std::to_string(slot));
                break;
            }
            is_free[slot] = 1;
        }
        for (std::size_t slot = 0; slot < generations.size() && !error_; ++slot) {
            if (generations[slot] == 0) {
                refuse("generations above 0, found 0 of slot " + std::to_string(slot));
            }
        }
        if (!error_) {
            pool = EntityPool(std::move(generations), std::move(free_slots));
        }
        leave();
    }

    template <typename T>
    void read_column(const EntityPool& pool, Column<T>& column) {
        const std::uint32_t count = count_of(k_owner_bytes + row_counter<T>().bytes(), "rows");
        column.reserve(count);
        for (std::uint32_t index = 0; index < count && !error_; ++index) {
            enter(std::size_t{index});
            const Entity owner = read_handle();
            if (!pool.is_alive(owner) || column.contains(owner)) {
                refuse("an owner that is alive and has no element yet");
            } else {
                walk_component(column.add(owner), *this);
            }
            leave();
        }
    }

    std::span<const std::byte> bytes_;
    std::size_t at_;
    std::size_t end_;
    const std::vector<std::uint32_t>* generations_ = nullptr;
    std::optional<FileError> error_;
};

}  // namespace

std::size_t payload_bytes(const World& world) {
    ByteCounter globals;
    walk_globals(world, globals);
    std::size_t bytes = globals.bytes() + 4 * (2 + world.entities.generations().size() +
                                               world.entities.free_slots().size());
    visit_columns(world, [&bytes](const char*, const auto& column) {
        bytes += 4 + column.size() * k_owner_bytes +
                 rows_bytes<ComponentOf<decltype(column)>>(column.elements());
    });
    return bytes;
}

std::byte* write_payload(const World& world, std::byte* to) {
    ByteWriter out(to);
    out.put_list(world.entities.generations());
    out.put_list(world.entities.free_slots());
    walk_globals(world, out);
    visit_columns(world, [&out](const char*, const auto& column) {
        out.put(static_cast<std::uint32_t>(column.size()));
        for (std::size_t index = 0; index < column.size(); ++index) {
            out.leaf(column.owners()[index]);
            walk_component(column.elements()[index], out);
        }
    });
    return out.at();
}

std::optional<FileError> read_payload(std::span<const std::byte> snapshot, std::size_t begin,
                                      std::size_t end, World& world) {
    ByteReader reader(snapshot, begin, end);
    reader.read_world(world);
    return reader.error();
}

}  // namespace handhold
