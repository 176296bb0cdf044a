#pragma once

// Every number a designer may change, with unit, range and description, and its JSON form.
#include "components/tuning.hpp"
#include "systems/host/tuning_json.hpp"
