#pragma once

#include <optional>
#include <type_traits>

#include "components/player.hpp"
#include "components/tuning.hpp"

namespace handhold {

// The tuning of a player of that scale: numbers with TuningInfo::scales are times the scale.
inline Tuning scaled(const Tuning& tuning, double scale) {
    Tuning result = tuning;
    visit_tuning(result, [scale](const TuningInfo& info, auto& field) {
        using Field = std::remove_cvref_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, double> || std::is_same_v<Field, Vec3>) {
            if (info.scales) {
                field *= scale;
            }
        }
    });
    return result;
}

// The tunings of several players, one at a time. Costs nothing while every scale is 1.
class TuningOfPlayers {
  public:
    // `tuning` must outlive this object.
    explicit TuningOfPlayers(const Tuning& tuning) : tuning_(tuning) {}

    // Valid until the next call.
    const Tuning& of(const PlayerOrigin& origin) {
        if (origin.scale == 1.0) {
            return tuning_;
        }
        if (!scaled_ || origin.scale != scale_) {
            scale_ = origin.scale;
            scaled_ = scaled(tuning_, scale_);
        }
        return *scaled_;
    }

  private:
    const Tuning& tuning_;
    double scale_ = 1.0;
    std::optional<Tuning> scaled_;
};

}  // namespace handhold
