#ifndef HANDHOLD_BASE_H
#define HANDHOLD_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <handhold/version.h>

/* Handhold in C99: conventions, results, ids and host hooks. Include <handhold/handhold.h>.
 *
 * Units are SI: metres, seconds, kilograms, radians. Frames are right-handed: +Y up, -Z ahead,
 * +X right. Rotations are unit quaternions.
 *
 * Calls. Every function returns a hh_result and never throws or crashes for a null pointer, a
 * stale id, a NaN or a number out of range. A call that fails changes nothing and writes no output;
 * hh_last_error() then says in one line what was wrong.
 *
 * Threads. Calls on different worlds may run at the same time. Calls on one world must not
 * overlap, not even two that only read. Functions without a world say what they allow.
 *
 * Definitions and outputs that begin with `struct_size` grow in later versions: fill them by
 * their hh_default_ function, which sets it. A library takes any struct_size from its first
 * version up to its own. */

#if defined(_WIN32)
#if defined(HANDHOLD_BUILDING)
#define HH_API __declspec(dllexport)
#else
#define HH_API
#endif
#elif defined(__GNUC__)
#define HH_API __attribute__((visibility("default")))
#else
#define HH_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hh_result {
    HH_OK = 0,
    HH_ERROR_NULL = 1,     /* a pointer that is needed is null */
    HH_ERROR_VERSION = 2,  /* struct_size is 0, or of a later version than the library */
    HH_ERROR_HANDLE = 3,   /* an id is null, stale or of another world */
    HH_ERROR_VALUE = 4,    /* a number is NaN or out of range, or a combination makes no sense */
    HH_ERROR_NAME = 5,     /* a name is taken, or nothing has it */
    HH_ERROR_STATE = 6,    /* not possible now, for instance a shape in use */
    HH_ERROR_CAPACITY = 7, /* the buffer is too small; the count says how much is needed */
    HH_ERROR_DATA = 8,     /* bytes that cannot be read: a snapshot, a glTF file, JSON */
    HH_ERROR_MEMORY = 9,   /* no memory left */
    HH_ERROR_INTERNAL = 10, /* a defect of the library; hh_host_hooks.assert_failed was called */
    HH_RESULT_32_BITS = 0x7fffffff /* no result: enums have a fixed size */
} hh_result;

/* The result's name, "HH_ERROR_HANDLE". Never null. Any thread. */
HH_API const char* hh_result_text(hh_result result);
/* What the calling thread's last failed call found wrong, one line. Never null; empty before the
 * first failure. Valid until the thread's next failure. */
HH_API const char* hh_last_error(void);
/* The version of the library that is running: compare with HANDHOLD_VERSION_MAJOR and so on.
 * Null pointers are skipped. Any thread. */
HH_API void hh_version(uint32_t* major, uint32_t* minor, uint32_t* patch);

typedef struct hh_vec3 {
    double x, y, z;
} hh_vec3;

typedef struct hh_quat {
    double x, y, z, w;
} hh_quat;

/* A rigid transform: rotates, then translates. Inputs need a unit rotation within 0.001. */
typedef struct hh_pose {
    hh_vec3 position; /* metres */
    hh_quat rotation;
} hh_pose;

/* The pose at the origin, not rotated. Any thread. */
HH_API hh_pose hh_identity_pose(void);

/* Equal on every machine and compiler, unlike sin, cos and atan2 of C: for inputs that must replay
 * bit for bit. Errors are below 1e-14 up to 1e6 rad; beyond that, and for NaN, sine is 0 and cosine
 * 1. Null outputs are skipped. hh_atan2 gives 0 for (0, 0) and NaN. Any thread. */
HH_API void hh_sin_cos(double angle_rad, double* sine, double* cosine);
HH_API double hh_atan2(double y, double x);

/* Ids: plain values. All zero is null. An id whose object was removed finds nothing, even if its
 * index is used again. Ids of two worlds must not be mixed; that is not always detected. */
typedef struct hh_shape {
    uint32_t index, generation;
} hh_shape;
typedef struct hh_body {
    uint32_t index, generation;
} hh_body;
typedef struct hh_joint {
    uint32_t index, generation;
} hh_joint;
typedef struct hh_player {
    uint32_t index, generation;
} hh_player;

typedef enum hh_side { HH_LEFT = 0, HH_RIGHT = 1, HH_SIDE_32_BITS = 0x7fffffff } hh_side;

/* A simulation with its shapes, bodies and players. Several may exist. */
typedef struct hh_world hh_world;

typedef enum hh_log_level { HH_LOG_NOTE = 0, HH_LOG_ERROR = 1 } hh_log_level;

typedef void (*hh_task)(void* task_context, size_t index);

/* What the process lends the library. Null functions: the library's own.
 * Memory comes from the global operator new, which a program may replace as usual; the shared
 * library and the standard library inside it then use the replacement too, once per process. Apart
 * from that a world's blocks are taken and given back by the threads that call it, and by those of
 * parallel_for: a replacement with an arena a thread gives each world its own. A host that uses
 * Bullet needs its double-precision build, and sets btAlignedAllocSetCustom before the first
 * world. */
typedef struct hh_host_hooks {
    uint32_t struct_size;
    void* context; /* passed to each of the functions */
    /* Called by any thread that calls the library. `message` is one line, valid during the call. */
    void (*log)(void* context, hh_log_level level, const char* message);
    /* A defect of the library was found; the call then returns HH_ERROR_INTERNAL. */
    void (*assert_failed)(void* context, const char* message);
    /* Calls task(task_context, i) once for every i in [0, count), on any threads, and returns when
     * all are done. Indices should start in ascending order. */
    void (*parallel_for)(void* context, size_t count, hh_task task, void* task_context);
    /* Without parallel_for: threads of the library's own pool, the caller's included. [1, 256];
     * default 1. Results do not depend on it. */
    uint32_t thread_count;
} hh_host_hooks;

HH_API hh_host_hooks hh_default_host_hooks(void);
/* Sets the hooks of the process; null: back to the defaults. HH_ERROR_STATE while a world exists.
 * Not beside any other call of the library. */
HH_API hh_result hh_set_host_hooks(const hh_host_hooks* hooks);
/* Threads of the library's own pool, as hh_host_hooks.thread_count, also while worlds exist: for
 * instance all while a level loads. HH_ERROR_STATE if the host lends parallel_for. Not beside any
 * other call of the library. */
HH_API hh_result hh_set_thread_count(uint32_t count);
HH_API uint32_t hh_thread_count(void);

#ifdef __cplusplus
}
#endif

#endif
