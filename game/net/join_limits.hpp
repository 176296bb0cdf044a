#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace handhold {

struct JoinRate {
    double per_s = 0.0;
    double at_once = 0.0;  // joins that were not used may follow at once
};

// How many may join: a state costs more than a tick. Nobody can use up what the others need, apart
// from many addresses, or persons, together.
class JoinLimits {
  public:
    JoinLimits(JoinRate all, JoinRate each) : all_(all), each_(each), left_(all.at_once) {}

    // Counts a join of an address or a person. False, and nothing is counted: too many of late.
    bool take(const std::string& who) {
        const auto found = left_of_.try_emplace(who, each_.at_once).first;
        if (left_ < 1.0 || found->second < 1.0) {
            return false;
        }
        left_ -= 1.0;
        found->second -= 1.0;
        return true;
    }
    // Keeps only those who have joined of late, so their number is bounded by that of joins.
    void refill(double elapsed_s) {
        left_ = std::min(left_ + elapsed_s * all_.per_s, all_.at_once);
        for (auto& [who, left] : left_of_) {
            left += elapsed_s * each_.per_s;
        }
        std::erase_if(left_of_, [this](const auto& one) { return one.second >= each_.at_once; });
    }

  private:
    JoinRate all_;
    JoinRate each_;
    double left_;
    std::map<std::string, double> left_of_;
};

}  // namespace handhold
