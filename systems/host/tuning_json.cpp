#include "systems/host/tuning_json.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/io/json.hpp"

namespace handhold {
namespace {

// "hand.reach_m" -> {"hand", "reach_m"}.
std::pair<std::string_view, std::string_view> split_name(std::string_view name) {
    const std::size_t dot = name.find('.');
    return {name.substr(0, dot), name.substr(dot + 1)};
}

void read_field(const JsonValue& value, const NumberRange& range, double& field) {
    field = value.number(range);
}
void read_field(const JsonValue& value, const NumberRange& range, Vec3& field) {
    field = value.vector(range);
}
void read_field(const JsonValue& value, const NumberRange& range, std::int32_t& field) {
    field = static_cast<std::int32_t>(
        value.integer(static_cast<std::int64_t>(range.low), static_cast<std::int64_t>(range.high)));
}
void read_field(const JsonValue& value, const NumberRange&, SupportFollow& field) {
    field = static_cast<SupportFollow>(value.integer(0, 2));
}

nlohmann::json field_json(double field) { return field; }
nlohmann::json field_json(std::int32_t field) { return field; }
nlohmann::json field_json(SupportFollow field) { return static_cast<std::int32_t>(field); }
nlohmann::json field_json(const Vec3& field) { return {field.x(), field.y(), field.z()}; }

struct Group {
    std::string_view name;
    std::vector<std::string_view> numbers;
};

std::vector<Group> groups_of(const Tuning& tuning) {
    std::vector<Group> groups;
    visit_tuning(tuning, [&groups](const TuningInfo& info, const auto&) {
        const auto [group, number] = split_name(info.name);
        if (groups.empty() || groups.back().name != group) {
            groups.push_back({group, {}});
        }
        groups.back().numbers.push_back(number);
    });
    return groups;
}

void refuse_unknown(const JsonValue& root, const Tuning& tuning) {
    std::vector<std::string_view> names;
    for (const Group& group : groups_of(tuning)) {
        names.push_back(group.name);
        if (const JsonValue value = root[group.name]; value.exists()) {
            value.allow_only(group.numbers);
        }
    }
    root.allow_only(names);
}

}  // namespace

Result<Tuning> parse_tuning(std::string_view text, const std::string& file) {
    Result<JsonDocument> document = JsonDocument::parse(text, file);
    if (!document) {
        return document.error();
    }
    Tuning tuning;
    const JsonValue root = document.value().root();
    refuse_unknown(root, tuning);
    visit_tuning(tuning, [&root](const TuningInfo& info, auto& field) {
        const auto [group, number] = split_name(info.name);
        if (const JsonValue value = root[group]; value.exists() && value[number].exists()) {
            read_field(value[number], {info.low, info.high, false}, field);
        }
    });
    if (tuning.phases.kappa_heavy_kg <= tuning.phases.kappa_light_kg) {
        root["phases"].refuse("kappa_heavy_kg above kappa_light_kg");
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    return tuning;
}

std::string tuning_to_json(const Tuning& tuning) {
    nlohmann::json json = nlohmann::json::object();
    visit_tuning(tuning, [&json](const TuningInfo& info, const auto& field) {
        const auto [group, number] = split_name(info.name);
        json[std::string(group)][std::string(number)] = field_json(field);
    });
    return json.dump(2);
}

}  // namespace handhold
