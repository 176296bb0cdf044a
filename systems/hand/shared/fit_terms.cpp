#include "systems/hand/shared/fit_terms.hpp"

#include <algorithm>
#include <numeric>

namespace handhold {

const char* name_of(FitTerm term) {
    constexpr std::array<const char*, k_fit_term_count> k_names = {
        "sync",    "touch",  "tip",  "pad",  "opposition", "spread",
        "rest",    "alike",  "fan",  "roll", "couple",     "penetration",
        "overlap", "joints", "bend", "claw", "apart",      "palm limits"};
    return term < FitTerm::count ? k_names[static_cast<std::size_t>(term)] : "";
}

double sum_of(const FitTerms::Costs& cost_m2) {
    return std::accumulate(cost_m2.begin(), cost_m2.end(), 0.0);
}

double sum_of(const FitTerms& terms) {
    double sum_m2 = 0.0;
    for (const FitTerms::Costs& cost_m2 : terms.cost_m2) {
        sum_m2 += sum_of(cost_m2);
    }
    return sum_m2;
}

FitTerm largest_of(const FitTerms::Costs& cost_m2) {
    return static_cast<FitTerm>(std::ranges::max_element(cost_m2) - cost_m2.begin());
}

}  // namespace handhold
