#ifndef HANDHOLD_VERSION_H
#define HANDHOLD_VERSION_H

/* The library's semantic version. CMake reads it from here. */
#define HANDHOLD_VERSION_MAJOR 0
#define HANDHOLD_VERSION_MINOR 2
#define HANDHOLD_VERSION_PATCH 0

#define HANDHOLD_VERSION_TEXT "0.2.0"

#endif
