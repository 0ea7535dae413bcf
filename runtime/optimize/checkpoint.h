#pragma once
// Where an optimization stands, in a file: it goes on from there after a stop.
#include <string>

#include "runtime/frame/node_trainer.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

struct Checkpoint {
  uint32_t pictures = 0;  // to learn from, in all
  uint32_t done = 0;
  std::vector<float> extents;  // by node
  TrainingState state;
};

// Tells scenes apart, before anything was learned.
uint64_t mark_of(const BakedScene& baked);

// A file of its own, whole or absent.
void write_checkpoint(const Checkpoint& checkpoint, uint64_t mark, const std::string& path);
// Throws Error(refused_input) where there is a file that write_checkpoint() did not write.
void check_checkpoint(const std::string& path);
// False where there is none. Throws Error(refused_input) where it is of another scene or was
// altered.
bool read_checkpoint(uint64_t mark, const std::string& path, Checkpoint& checkpoint);

}  // namespace voyager
