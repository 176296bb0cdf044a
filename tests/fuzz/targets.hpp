#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

// Fuzz targets, one for each file format, and one for messages. Each passes the bytes to the reader
// and, if they are accepted, uses the result as the runtime would; a broken promise aborts. The
// ordinary tests replay the corpus.
namespace handhold::fuzz {

using Bytes = std::span<const std::uint8_t>;

void run_scene(Bytes bytes);
void run_gltf(Bytes bytes);
void run_recording(Bytes bytes);
void run_tuning(Bytes bytes);
void run_shots(Bytes bytes);
void run_station(Bytes bytes);     // a station's description
void run_controller(Bytes bytes);  // a controller's profile
void run_csv(Bytes bytes);         // a table of the lab
void run_net(Bytes bytes);         // a message between servers and peers of a match
// A packet, a state or a recording of a match, or a whole course of messages. Both change examples
// that they make themselves, so seeds survive changes of the formats.
void run_match(Bytes bytes);
void run_peers(Bytes bytes);
// The first byte selects the meaning of the rest: 0 patches of a valid snapshot, 1 a payload, 2 a
// whole snapshot. Most inputs thus pass the checksum, and seeds survive changes of the schema.
void run_snapshot(Bytes bytes);

}  // namespace handhold::fuzz
