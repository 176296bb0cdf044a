#ifndef HANDHOLD_BASE_H
#define HANDHOLD_BASE_H

#include <stddef.h>
#include <stdint.h>

#include <handhold/version.h>

/* Handhold in C99: conventions, results, ids and host hooks. Include <handhold/handhold.h>.
 *
 * Units are SI: metres, seconds, kilograms, radians. Frames are right-handed: +Y up, -Z ahead,
 * +X right. Rotations are unit quaternions.
 *
 * Calls. Functions that can fail return a hh_result. No function throws, or crashes for a null
 * pointer, a stale id, a NaN or a number out of range. A call that fails changes nothing and writes
 * no output, except the needed count or size with HH_ERROR_CAPACITY; hh_last_error() then says in
 * one line what was wrong. After HH_ERROR_INTERNAL the world may be in an invalid state: destroy or
 * restore it.
 *
 * Floating point. Every call computes without exception traps, rounds to nearest and keeps denormals,
 * on the threads that it uses too, and leaves the environment of the calling thread as it was, flags
 * included. Hooks and queries of the host run in the library's environment.
 *
 * Stack. A call needs at most 96 KiB of the calling thread's stack, and as much on each thread that
 * runs its tasks, so threads with 112 KiB and more are large enough (musl's default is 128).
 *
 * Threads. Calls on different worlds may run at the same time. Calls on one world must not
 * overlap, not even two that only read. Functions without a world say what they allow; those named
 * hh_default_... allow any thread.
 *
 * Growth. Structs that begin with `struct_size` get fields in later versions, at their end. Their
 * hh_default_ function fills them. In an array, all elements have the struct_size of the first.
 * hh_player_pose, hh_hand_state and hh_event grow too, without a struct_size. A library takes every
 * size from that of version 0.2.0 up to its own; HH_ERROR_VERSION for others, which hh_default_
 * functions fill with zeros. All other structs keep their fields for good.
 *
 * Functions named ..._sized write a struct that grows: they take its size in bytes as the host was
 * compiled with it, and never write more. In C and C++ call the inline functions of the same names
 * without _sized, which pass it. Other languages call the ..._sized functions.
 *
 * Flags are uint8_t: 0 is false, anything else true. Enums have 32 bits. */

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
    HH_ERROR_VERSION = 2,  /* a size of a struct is not of a version that the library knows */
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

/* How far each finger is bent: thumb, index, middle, ring, little. 0: straight; 1: as in a fist;
 * above 1: as 1; below 0 or NaN: unknown. */
typedef struct hh_finger_curls {
    double fingers[5];
} hh_finger_curls;

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

typedef enum hh_log_level { HH_LOG_NOTE = 0, HH_LOG_ERROR = 1, HH_LOG_LEVEL_32_BITS = 0x7fffffff } hh_log_level;

typedef void (*hh_task)(void* task_context, size_t index);

/* Functions of the host that the library uses. Null functions are not called; without parallel_for
 * the library has its own threads.
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

HH_API hh_result hh_default_host_hooks_sized(hh_host_hooks* filled, size_t size);
static inline hh_host_hooks hh_default_host_hooks(void) {
    hh_host_hooks filled;
    hh_default_host_hooks_sized(&filled, sizeof(filled));
    return filled;
}
/* Sets the hooks of the process; null: back to the defaults. HH_ERROR_STATE while a world exists.
 * Not beside any other call of the library. */
HH_API hh_result hh_set_host_hooks(const hh_host_hooks* hooks);
/* Sets the number of threads of the library's own pool, [1, 256]. Allowed while worlds exist, for
 * instance to use all cores while a level loads. HH_ERROR_STATE if the host lends parallel_for. Not
 * beside any other call of the library. */
HH_API hh_result hh_set_thread_count(uint32_t count);
/* Number of threads of the library's own pool, the caller's included. Any thread. */
HH_API uint32_t hh_thread_count(void);

#ifdef __cplusplus
}
#endif

#endif
