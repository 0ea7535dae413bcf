#pragma once
// Where an optimization stands, in a file: it goes on from there after a stop.
#include <span>
#include <string>
#include <vector>

#include "runtime/frame/node_trainer.h"
#include "runtime/lod/baked_scene.h"
#include "runtime/scene/training_camera.h"

namespace voyager {

struct Checkpoint {
  uint32_t pictures = 0;  // to learn from, in all
  uint32_t done = 0;
  std::string asked;           // OptimizeGoal's
  std::vector<float> extents;  // by node
  TrainingState state;
};

// Tells scenes apart, before anything was learned, where views are from, and what draws them.
uint64_t mark_of(const BakedScene& baked, std::span<const TrainingCamera> cameras,
                 const std::string& device);

// The file of part k, where a scene learns in parts.
std::string kept_of_part(const std::string& kept, uint32_t k);
// The file of a whole scene and those of parts, as far as they are there: from the first that is
// missing on none is found.
std::vector<std::string> kept_files(const std::string& kept);

// A file of its own, whole or absent.
void write_checkpoint(const Checkpoint& checkpoint, uint64_t mark, const std::string& path);
// Throws Error(refused_input) where one of these files is not write_checkpoint()'s.
void check_checkpoints(const std::string& kept);
// False where there is none. Throws Error(refused_input) where it is of another scene or was
// altered.
bool read_checkpoint(uint64_t mark, const std::string& path, Checkpoint& checkpoint);

}  // namespace voyager
