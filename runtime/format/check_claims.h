#pragma once
// What a directory says of its chunks takes memory wherever a scene is read: arrays by node, slots
// by chunk, tables by subtree. 88 bytes of it can claim megabytes, and chunks that hold
// nothing, or that lie where a sparse file or a server has no bytes, cost no one anything.
#include <cstdint>

#include "runtime/format/reader.h"

namespace voyager {

// About what all chunks take in memory as a scene, by their counts and as stored.
uint64_t claimed_bytes(const SceneFile& file);

// Random, and the same while the process lives, so that it judges a file the same each time.
uint64_t process_seed();

// Reads nothing of a file that claims little. Of a larger file it tries some chunks, drawn with
// `seed`; a chunk that claims more is drawn more often. Throws Error(refused_input) if hardly any
// of them is sound, and what reading throws. Nothing else depends on the seed.
void check_claims(const SceneFile& file, uint64_t seed);

}  // namespace voyager
