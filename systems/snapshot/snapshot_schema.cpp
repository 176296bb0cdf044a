#include "systems/snapshot/snapshot_schema.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "systems/snapshot/snapshot_fields.hpp"

namespace handhold {
namespace {

class SchemaWriter : public PathVisitor {
  public:
    explicit SchemaWriter(std::string& text) : text_(text) {}

    static constexpr bool k_walks_types = true;
    // Walks only one element of an array; its line states the array's size. 0: as many as the
    // number before says.
    std::size_t count_walked(std::size_t size) {
        array_size_ = size;
        return 1;
    }
    using PathVisitor::enter;
    void enter(std::size_t /*index*/) { PathVisitor::enter(array_size_); }

    bool takes_whole(const Vec3& /*v*/) { return add_line("vec3"); }
    bool takes_whole(const Quat& /*q*/) { return add_line("quat"); }

    template <typename T>
    void leaf(const T& /*value*/) {
        if constexpr (std::is_same_v<T, Entity>) {
            add_line("entity");
        } else if constexpr (std::is_same_v<T, ShapeId>) {
            add_line("shape");
        } else if constexpr (std::is_same_v<T, bool>) {
            add_line("bool");
        } else if constexpr (std::is_enum_v<T>) {
            static_assert(sizeof(T) == 1, "enums in components are of one byte");
            add_line("enum(" + std::to_string(k_value_count<T>) + ")");
        } else if constexpr (std::is_floating_point_v<T>) {
            static_assert(sizeof(T) == 8, "numbers in components are double");
            add_line("f64");
        } else {
            add_line((std::is_signed_v<T> ? "i" : "u") + std::to_string(8 * sizeof(T)));
        }
    }

  private:
    bool add_line(const std::string& type) {
        text_ += path() + " " + type + "\n";
        return true;
    }

    std::string& text_;
    std::size_t array_size_ = 0;
};

std::string write_schema() {
    std::string text;
    SchemaWriter writer(text);
    const World world;
    walk_globals(world, writer);
    visit_columns(world, [&writer](const char* name, const auto& column) {
        using Component = std::remove_cvref_t<decltype(column.elements()[0])>;
        writer.enter(name);
        walk_component(Component{}, writer);
        writer.leave();
    });
    return text;
}

// Removes the first line and returns it in quotes, shortened and without control characters.
// Returns "the end" if nothing is left.
std::string take_shown_line(std::string_view& text) {
    if (text.empty()) {
        return "the end";
    }
    const std::size_t length = std::min(text.find('\n'), text.size());
    constexpr std::size_t k_max_length = 80;
    std::string line = "\"";
    for (const char c : text.substr(0, std::min(length, k_max_length))) {
        line += c >= ' ' && c <= '~' ? c : '?';
    }
    text.remove_prefix(std::min(length + 1, text.size()));
    return line + "\"";
}

}  // namespace

const std::string& snapshot_schema() {
    static const std::string k_schema = write_schema();
    return k_schema;
}

std::string schema_difference(std::string_view expected, std::string_view found) {
    if (expected == found) {
        return {};
    }
    while (!expected.empty() || !found.empty()) {
        const std::string expected_line = take_shown_line(expected);
        const std::string found_line = take_shown_line(found);
        if (expected_line != found_line) {
            return std::string("expected ")
                .append(expected_line)
                .append(", found ")
                .append(found_line);
        }
    }
    return "expected a line end after every field";
}

std::string text_of(PersistentId id) {
    char text[19];
    std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(id.value));
    return text;
}

}  // namespace handhold
