#pragma once

// Handhold: hands that grip any surface, inside the physics step. This header includes all public
// headers. Units are SI, frames are right-handed with +Y up, -Z forward and +X right.
#include <handhold/ecs.hpp>
#include <handhold/files.hpp>
#include <handhold/rigs.hpp>
#include <handhold/tuning.hpp>
#include <handhold/version.hpp>
