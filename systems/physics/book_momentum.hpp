#pragma once

#include "components/stats.hpp"
#include "engine/solver/model/islands.hpp"

// Adds the impulses of the velocity solve to the ledger, by receiver. Talk row 7.
//
// A player's share of the inverse mass (mass_shares.hpp) decides how much of an impulse becomes the
// player's own momentum; the rest goes to the virtual player. Runs while `graph` has the poses and
// inverse masses of the velocity solve.
namespace handhold {

void book_momentum(const ConstraintGraph& graph, MomentumLedger& ledger);

}  // namespace handhold
