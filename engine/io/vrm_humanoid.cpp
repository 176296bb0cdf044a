#include "engine/io/vrm_humanoid.hpp"

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "engine/io/glb.hpp"
#include "engine/io/json.hpp"

namespace handhold {
namespace {

using Humanoid = std::map<std::string, std::string>;

// Follows the members `keys` from object to object. nullopt if one of them is absent.
std::optional<JsonValue> find_member(JsonValue value, std::initializer_list<const char*> keys) {
    for (const char* const key : keys) {
        if (!value.is_object()) {
            return std::nullopt;
        }
        value = value[key];
    }
    return value.exists() ? std::optional(value) : std::nullopt;
}

// The name of each node; empty if it has none or if another node has the same name.
std::vector<std::string> node_names(const JsonValue& root) {
    std::vector<std::string> names;
    std::map<std::string, int> uses;
    for (const JsonValue& node : root["nodes"].optional_items()) {
        names.push_back(node["name"].is_text() ? node["name"].text_or("") : "");
        ++uses[names.back()];
    }
    for (std::string& name : names) {
        if (uses[name] > 1) {
            name.clear();
        }
    }
    return names;
}

void add_bone(const std::string& bone, const JsonValue& node, const std::vector<std::string>& names,
              Humanoid& humanoid) {
    const auto last = static_cast<std::int64_t>(names.size()) - 1;
    const std::int64_t index = node.integer(0, last);
    if (index <= last && !names[static_cast<std::size_t>(index)].empty()) {
        humanoid[bone] = names[static_cast<std::size_t>(index)];
    }
}

}  // namespace

Result<Humanoid> parse_vrm_humanoid(std::string_view bytes, const std::string& file) {
    const Result<GlbChunks> chunks = split_glb(bytes, file);
    if (!chunks) {
        return chunks.error();
    }
    Result<JsonDocument> document = JsonDocument::parse(chunks.value().json, file);
    if (!document) {
        return document.error();
    }
    const JsonValue root = document.value().root();
    Humanoid humanoid;
    const std::vector<std::string> names = node_names(root);
    if (const auto bones = find_member(root, {"extensions", "VRM", "humanoid", "humanBones"})) {
        for (const JsonValue& bone : bones->items()) {
            add_bone(bone["bone"].text(), bone["node"], names, humanoid);
        }
    }
    if (const auto bones =
            find_member(root, {"extensions", "VRMC_vrm", "humanoid", "humanBones"})) {
        for (const auto& [bone, value] : bones->optional_members()) {
            add_bone(bone, value["node"], names, humanoid);
        }
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    return humanoid;
}

}  // namespace handhold
