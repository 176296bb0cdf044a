#pragma once

#include <array>
#include <cstddef>

// Tables with a text for each value of an enum. The enum's values are 0 to Enum::count - 1.
namespace handhold {

template <typename Enum>
struct EnumText {
    Enum value;
    const char* text;
};

template <typename Enum>
using EnumTexts = std::array<EnumText<Enum>, static_cast<std::size_t>(Enum::count)>;

// True if the table has every value at its own index. For static_assert.
template <typename Enum>
constexpr bool is_in_order(const EnumTexts<Enum>& table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[i].value != static_cast<Enum>(i) || table[i].text == nullptr) {
            return false;
        }
    }
    return true;
}

// "unknown" if `value` is none of the enum's values.
template <typename Enum>
const char* text_of(const EnumTexts<Enum>& table, Enum value) {
    const auto i = static_cast<std::size_t>(value);
    return i < table.size() ? table[i].text : "unknown";
}

}  // namespace handhold
