#ifndef HANDHOLD_HANDHOLD_H
#define HANDHOLD_HANDHOLD_H

/* Handhold: hands that grip any surface, inside the physics step. The C interface, for any
 * language: conventions in base.h. C++ hosts may use handhold.hpp, which wraps it. */
#include <handhold/base.h>
#include <handhold/convert.h>
#include <handhold/level.h>
#include <handhold/match.h>
#include <handhold/players.h>
#include <handhold/skeletons.h>
#include <handhold/world.h>
#include <handhold/your_physics.h>

#endif
