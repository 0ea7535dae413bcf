#pragma once
// What a directory says of its chunks takes memory wherever a scene is read: arrays by node, slots
// by chunk, tables by subtree. 88 bytes of it can claim megabytes, and chunks that hold
// nothing, or that lie where a sparse file or a server has no bytes, cost no one anything.
#include <cstdint>

#include "runtime/format/reader.h"

namespace voyager {

// About what all chunks take in memory as a scene, by their counts and as stored.
uint64_t claimed_bytes(const SceneFile& file);

// Of a file that claims little nothing is read. Of another some chunks are, each as likely as what
// it claims is large, in an order that `seed` decides: where hardly any is sound, throws
// Error(refused_input), and else as reading does.
void check_claims(const SceneFile& file, uint64_t seed);

}  // namespace voyager
