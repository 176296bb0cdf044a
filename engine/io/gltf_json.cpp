#include "engine/io/gltf_json.hpp"

namespace handhold::gltf {

int read_index(const JsonValue& value) {
    return value.exists() ? static_cast<int>(value.integer(0, k_max_index)) : k_none;
}

std::uint64_t read_size(const JsonValue& value, std::int64_t low) {
    return static_cast<std::uint64_t>(value.integer(low, k_max_size));
}

std::uint64_t read_offset(const JsonValue& value) { return value.exists() ? read_size(value) : 0; }

std::vector<int> read_index_array(const JsonValue& array) {
    std::vector<int> indices;
    for (const JsonValue& item : array.optional_items()) {
        indices.push_back(read_index(item));
    }
    return indices;
}

std::map<std::string, int> read_attributes(const JsonValue& object) {
    std::map<std::string, int> attributes;
    for (const auto& [name, value] : object.optional_members()) {
        attributes.emplace(name, read_index(value));
    }
    return attributes;
}

std::vector<double> read_numbers(const JsonValue& array, std::size_t count) {
    std::vector<double> numbers;
    if (!array.exists()) {
        return numbers;
    }
    for (const JsonValue& number : array.items()) {
        numbers.push_back(number.number());
    }
    if (numbers.size() != count) {
        array.refuse("an array of " + std::to_string(count) + " numbers");
        numbers.resize(count);
    }
    return numbers;
}

JsonValue extension_of(const JsonValue& object, const char* name) {
    const JsonValue extensions = object["extensions"];
    return extensions.exists() ? extensions[name] : extensions;
}

}  // namespace handhold::gltf
