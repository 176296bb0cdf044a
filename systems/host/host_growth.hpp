#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "systems/host/host_call.hpp"

// Structs of the C interface that get fields in later versions. A host and the library may have
// been compiled with different versions of a struct: each reads and writes the fields that both
// know.
namespace handhold {

// Name of a struct of the C interface, "hh_body_def".
template <typename Struct>
constexpr std::string_view name_of_struct() {
    // GCC: "... [with Struct = hh_body_def; ...]". Clang: "... [Struct = hh_body_def]".
    std::string_view name = __PRETTY_FUNCTION__;
    name.remove_prefix(name.find("Struct = ") + std::string_view("Struct = ").size());
    return name.substr(0, name.find_first_of(";]"));
}

// Throws HH_ERROR_VERSION for a struct of `size` bytes: this library knows sizes from `first_size`
// to `own_size`. `is_filled`: an hh_default_ function sets its struct_size.
[[noreturn]] void fail_size(std::string_view name, bool is_filled, std::size_t size,
                            std::size_t first_size, std::size_t own_size);

// Checks the size of a host's struct.
template <typename Struct>
void require_size(std::size_t size, std::size_t first_size = sizeof(Struct),
                  std::size_t own_size = sizeof(Struct)) {
    if (size < first_size || size > own_size) [[unlikely]] {
        fail_size(
            name_of_struct<Struct>(), requires(Struct s) { s.struct_size; }, size, first_size,
            own_size);
    }
}

// Reads a definition of any version up to this library's: fields that it lacks have their default.
// `first_size`: size of the struct in its first version. HH_ERROR_VERSION for other sizes.
template <typename Def>
Def read_def(const Def* def, const Def& defaults, std::size_t first_size = sizeof(Def)) {
    require(def != nullptr, HH_ERROR_NULL, "the definition is null");
    const std::size_t size = def->struct_size;
    require_size<Def>(size, first_size);
    Def read = defaults;
    std::memcpy(&read, def, size);
    return read;
}

// Writes an output of any version up to this library's: the fields that the host knows.
// HH_ERROR_VERSION for other sizes.
template <typename Out>
void write_out(Out* out, Out value, std::size_t first_size = sizeof(Out)) {
    require(out != nullptr, HH_ERROR_NULL, "the output is null");
    const std::uint32_t size = out->struct_size;
    require_size<Out>(size, first_size);
    value.struct_size = size;
    std::memcpy(out, &value, size);
}

// Fills a host's struct of `size` bytes with defaults. If this library does not know a version of
// that size, fills it with zeros, so that calls refuse it.
template <typename Def>
hh_result write_default(Def* filled, std::size_t size, Def defaults,
                        std::size_t first_size = sizeof(Def)) noexcept {
    return call([&] {
        require(filled != nullptr, HH_ERROR_NULL, "the output is null");
        std::memset(filled, 0, size);
        require_size<Def>(size, first_size);
        defaults.struct_size = static_cast<std::uint32_t>(size);
        std::memcpy(filled, &defaults, size);
    });
}

// Element of an array of the host, whose elements have the size of the host's version.
template <typename T>
const T& sized_element(const T* first, std::size_t size, std::size_t i) {
    return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(first) + i * size);
}
template <typename T>
T& sized_element(T* first, std::size_t size, std::size_t i) {
    return *reinterpret_cast<T*>(reinterpret_cast<char*>(first) + i * size);
}

// Reads element `i` of an array of definitions. HH_ERROR_VERSION unless it has the struct_size of
// the first element, which this library knows.
template <typename Def>
Def read_def_at(const Def* defs, std::size_t i, const Def& defaults) {
    const Def& element = sized_element(defs, defs->struct_size, i);
    require(element.struct_size == defs->struct_size, HH_ERROR_VERSION, [&] {
        const std::string name(name_of_struct<Def>());
        return "element " + std::to_string(i) + " of an array of " + name + " has struct_size " +
               std::to_string(element.struct_size) + ", the first has " +
               std::to_string(defs->struct_size) + ": fill each by hh_default_" + name.substr(3);
    });
    return read_def(&element, defaults);
}

// Layout of a struct that grows and contains an array of structs that grow. Its own later fields
// come behind the array.
struct NestedLayout {
    std::size_t size;         // bytes of the outer struct
    std::size_t nested_size;  // bytes of one element
    std::size_t nested_at;    // offset of the array, equal in all versions
    std::size_t nested_count;

    std::size_t tail_at() const { return nested_at + nested_count * nested_size; }
};

// Copies the fields that two versions of such a struct have in common.
inline void copy_common_fields(void* to, const NestedLayout& to_layout, const void* from,
                               const NestedLayout& from_layout) {
    char* const out = static_cast<char*>(to);
    const char* const in = static_cast<const char*>(from);
    std::memcpy(out, in, to_layout.nested_at);
    const std::size_t nested_size = std::min(to_layout.nested_size, from_layout.nested_size);
    for (std::size_t i = 0; i < to_layout.nested_count; ++i) {
        std::memcpy(out + to_layout.nested_at + i * to_layout.nested_size,
                    in + from_layout.nested_at + i * from_layout.nested_size, nested_size);
    }
    std::memcpy(
        out + to_layout.tail_at(), in + from_layout.tail_at(),
        std::min(to_layout.size - to_layout.tail_at(), from_layout.size - from_layout.tail_at()));
}

}  // namespace handhold
