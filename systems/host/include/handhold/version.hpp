#pragma once

// The library's semantic version, for C++.
#include <handhold/version.h>
