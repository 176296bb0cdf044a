// Solver, model: which blocks of an island a solve includes.
#include "engine/solver/model/island_view.hpp"

namespace handhold {

bool passes(BlockFilter filter, const RowBlock& block) {
    switch (filter) {
        case BlockFilter::without_contacts:
            return !is_contact(block);
        case BlockFilter::without_drives:
            return !is_drive(block);
        case BlockFilter::all:
            break;
    }
    return true;
}

bool takes_part(const IslandView& island, const RowBlock& block) {
    return passes(island.filter, block) &&
           (island.bodies[block.a].inverse_mass > 0.0 || island.bodies[block.b].inverse_mass > 0.0);
}

}  // namespace handhold
