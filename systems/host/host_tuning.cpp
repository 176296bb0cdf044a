// Tuning and statistics of the C interface (handhold/world.h).
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <type_traits>

#include "components/tuning_check.hpp"
#include "systems/host/host_world.hpp"
#include "systems/host/tuning_json.hpp"

namespace handhold {
namespace {

template <typename Field>
constexpr std::size_t component_count() {
    return std::is_same_v<std::remove_cvref_t<Field>, Vec3> ? 3 : 1;
}

void read_components(const double& field, double* values) { *values = field; }
void read_components(const std::int32_t& field, double* values) { *values = field; }
void read_components(const SupportFollow& field, double* values) {
    *values = static_cast<double>(field);
}
void read_components(const Vec3& field, double* values) { std::copy_n(field.data(), 3, values); }

void write_components(double& field, const double* values) { field = *values; }
void write_components(std::int32_t& field, const double* values) {
    field = static_cast<std::int32_t>(*values);
}
void write_components(SupportFollow& field, const double* values) {
    field = static_cast<SupportFollow>(static_cast<int>(*values));
}
void write_components(Vec3& field, const double* values) { field = Vec3(values); }

void require_in_range(const TuningInfo& info, double value) {
    require(value >= info.low && value <= info.high, HH_ERROR_VALUE, [&] {
        return std::string(info.name) + " must lie in [" + number_text(info.low) + ", " +
               number_text(info.high) + "], not be " + number_text(value);
    });
}

// Calls use(info, field) for the number with this name.
template <typename TuningType, typename Use>
void with_number(TuningType& tuning, const char* name, std::size_t count, const Use& use) {
    require(name != nullptr, HH_ERROR_NULL, "the name is null");
    bool is_found = false;
    visit_tuning(tuning, [&](const TuningInfo& info, auto& field) {
        if (std::string_view(info.name) != name) {
            return;
        }
        is_found = true;
        require(count == component_count<decltype(field)>(), HH_ERROR_VALUE,
                "the number has another count of components");
        use(info, field);
    });
    require(is_found, HH_ERROR_NAME, [&] {
        return std::string("no number is named ") + name + ": hh_tuning_describe lists them";
    });
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_default_tuning_info_sized(hh_tuning_info* filled, size_t size) {
    hh_tuning_info info{};
    return write_default(filled, size, info);
}

hh_result hh_tuning_describe(size_t index, hh_tuning_info* info) {
    return call([&] {
        require(info != nullptr, HH_ERROR_NULL, "the output is null");
        std::size_t at = 0;
        hh_tuning_info found = hh_default_tuning_info();
        const Tuning tuning;
        visit_tuning(tuning, [&](const TuningInfo& number, const auto& field) {
            if (at++ == index) {
                found = {found.struct_size,
                         number.name,
                         number.unit,
                         number.what,
                         number.low,
                         number.high,
                         component_count<decltype(field)>(),
                         number.scales};
            }
        });
        require(found.name != nullptr, HH_ERROR_VALUE, "no number with this index");
        write_out(info, found);
    });
}

hh_result hh_world_get_tuning(const hh_world* world, const char* name, double* values,
                              size_t count) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(values != nullptr, HH_ERROR_NULL, "the output is null");
        with_number(host.tuning, name, count,
                    [&](const TuningInfo&, const auto& field) { read_components(field, values); });
    });
}

hh_result hh_world_set_tuning(hh_world* world, const char* name, const double* values,
                              size_t count) {
    return call([&] {
        hh_world& host = world_of(world);
        require(values != nullptr, HH_ERROR_NULL, "the values are null");
        Tuning changed = host.tuning;
        with_number(changed, name, count, [&](const TuningInfo& info, auto& field) {
            for (std::size_t i = 0; i < count; ++i) {
                require_in_range(info, values[i]);
            }
            write_components(field, values);
        });
        check_tuning(changed);
        host.tuning = changed;
    });
}

hh_result hh_world_tuning_numbers(const hh_world* world, double* values, size_t capacity,
                                  size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        std::vector<double> numbers;
        visit_tuning(host.tuning, [&](const TuningInfo&, const auto& field) {
            numbers.resize(numbers.size() + component_count<decltype(field)>());
            read_components(field, &numbers.back() + 1 - component_count<decltype(field)>());
        });
        write_list(numbers.size(), values, capacity, count,
                   [&](std::size_t i) { return numbers[i]; });
    });
}

hh_result hh_world_set_tuning_numbers(hh_world* world, const double* values, size_t count) {
    return call([&] {
        hh_world& host = world_of(world);
        require(values != nullptr, HH_ERROR_NULL, "the values are null");
        Tuning changed = host.tuning;
        std::size_t at = 0;
        visit_tuning(changed, [&](const TuningInfo& info, auto& field) {
            constexpr std::size_t k_own = component_count<decltype(field)>();
            require(at + k_own <= count, HH_ERROR_VALUE,
                    "the tuning has more numbers than were given");
            for (std::size_t i = 0; i < k_own; ++i) {
                require_in_range(info, values[at + i]);
            }
            write_components(field, values + at);
            at += k_own;
        });
        require(at == count, HH_ERROR_VALUE, "the tuning has fewer numbers than were given");
        check_tuning(changed);
        host.tuning = changed;
    });
}

hh_result hh_world_load_tuning(hh_world* world, const char* json, size_t size) {
    return call([&] {
        hh_world& host = world_of(world);
        require(json != nullptr, HH_ERROR_NULL, "the text is null");
        Result<Tuning> parsed = parse_tuning({json, size}, "tuning");
        if (!parsed) {
            throw HostError{HH_ERROR_DATA, parsed.error().message()};
        }
        check_tuning(parsed.value());
        host.tuning = parsed.value();
    });
}

hh_result hh_default_world_stats_sized(hh_world_stats* filled, size_t size) {
    hh_world_stats stats{};
    return write_default(filled, size, stats);
}

hh_result hh_world_get_stats(const hh_world* world, hh_world_stats* stats) {
    return call([&] {
        const hh_world& host = world_of(world);
        const StageStats& last = host.stats;
        hh_world_stats read = hh_default_world_stats();
        read.bodies = host.world.body.size();
        read.joints = host.world.joint.size();
        read.players = host.world.player.size();
        read.shapes = shape_count(host);
        read.contacts = last.contacts;
        read.islands = last.islands;
        read.newton_iterations = last.newton_iterations;
        read.hand_error_m = last.hand_error_m;
        read.overlap_m = last.residual_m;
        read.joint_error_m = last.joint_error_m;
        read.step_us = std::accumulate(last.stage_us.begin(), last.stage_us.end(), 0.0);
        read.joint_error_rad = last.joint_error_rad;
        read.islands_pushed = last.islands_pushed;
        read.contact_rounds = last.contact_rounds;
        read.hands_closed = last.grab_onsets;
        read.hands_gripped = last.grabs_gripped;
        static_assert(int{MomentumLedger::receiver_count} == int{HH_MOMENTUM_RECEIVERS});
        for (std::size_t i = 0; i < MomentumLedger::receiver_count; ++i) {
            read.momentum.linear_kgmps[i] = to_c(last.ledger.linear_kgmps[i]);
            read.momentum.angular_kgm2ps[i] = to_c(last.ledger.angular_kgm2ps[i]);
        }
        const hh_contact* deepest = nullptr;
        for (const hh_contact& contact : host.contact_list) {
            if (contact.depth_m > (deepest == nullptr ? 0.0 : deepest->depth_m)) {
                deepest = &contact;
            }
        }
        if (deepest != nullptr) {
            read.deepest_a = deepest->body_a;
            read.deepest_b = deepest->body_b;
        }
        write_out(stats, read, offsetof(hh_world_stats, joint_error_rad));
    });
}

const char* hh_stage_name(size_t stage) {
    return stage < static_cast<size_t>(Stage::count) ? name_of(static_cast<Stage>(stage)) : nullptr;
}

const char* hh_fallback_name(size_t fallback) {
    return fallback < static_cast<size_t>(Fallback::count)
               ? name_of(static_cast<Fallback>(fallback))
               : nullptr;
}

hh_result hh_world_stage_times(const hh_world* world, double* us, size_t capacity, size_t* count) {
    return call([&] {
        const StageStats& last = world_of(world).stats;
        write_list(last.stage_us.size(), us, capacity, count,
                   [&](std::size_t i) { return last.stage_us[i]; });
    });
}

hh_result hh_world_fallbacks(const hh_world* world, uint64_t* times, size_t capacity,
                             size_t* count) {
    return call([&] {
        const StageStats& last = world_of(world).stats;
        write_list(last.fallbacks.size(), times, capacity, count,
                   [&](std::size_t i) { return std::uint64_t{last.fallbacks[i]}; });
    });
}
