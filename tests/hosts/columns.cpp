// Headers of columns and stages, in a program without exceptions and RTTI.
#include <handhold/ecs.hpp>

std::size_t body_count(const handhold::World& world) { return world.body.size(); }
