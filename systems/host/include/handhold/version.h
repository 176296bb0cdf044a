#ifndef HANDHOLD_VERSION_H
#define HANDHOLD_VERSION_H

/* The library's semantic version. CMake reads it from here. */
#define HANDHOLD_VERSION_MAJOR 0
#define HANDHOLD_VERSION_MINOR 1
#define HANDHOLD_VERSION_PATCH 0

#define HANDHOLD_VERSION_TEXT "0.1.0"

#endif
