#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

// What fuzzing calls with any bytes, one function a file format. Each gives them to the reader and,
// where they are accepted, uses what was read as the runtime would; a broken promise calls abort.
// The corpus is replayed by the ordinary tests too.
namespace handhold::fuzz {

using Bytes = std::span<const std::uint8_t>;

void run_scene(Bytes bytes);
void run_gltf(Bytes bytes);
void run_recording(Bytes bytes);
void run_tuning(Bytes bytes);
void run_shots(Bytes bytes);
// The first byte says what the others are: 0 patches of a good snapshot, 1 a payload, 2 all of a
// snapshot. So most inputs come behind the checksum, and seeds outlive changes of the schema.
void run_snapshot(Bytes bytes);

}  // namespace handhold::fuzz
