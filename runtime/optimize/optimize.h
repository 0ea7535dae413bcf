#pragma once
// Merged Gaussians that learn what they stand for (docs/optimizing.md): pictures of cuts are
// compared with the truth of METHOD §12, and nodes follow the gradient of the root mean square
// error of colours, with a little of the coverage's (kCoverageWeight).
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/frame/backend.h"
#include "runtime/lod/baked_scene.h"
#include "runtime/scene/training_camera.h"

namespace voyager {

// How many pictures to learn from. 0: as many as there is time for in `minutes`, with what is
// measured beside them.
struct OptimizeGoal {
  uint32_t pictures = 0;
  double minutes = 0;
  uint64_t memory = 0;     // bytes of the host's that this may take beside the scene; 0: any number
  uint32_t held_out = 24;  // views
  std::string asked{};     // as messages say what was asked for in all; optimize_nodes() sets it
  double keep_milliseconds = 60000;  // between one time that what was learned is kept and the next
  // In the scene's world: up to half of the views are from near them (training_views.h). May be
  // none.
  std::span<const TrainingCamera> cameras{};
};
// So many for each merged node.
enum class OptimizeQuality { draft, good, best };
uint32_t pictures_of(OptimizeQuality quality, uint64_t merged_nodes);

// Held-out views at a τ: PSNR to the truth, dB, and nodes of the cut, in leaves.
struct HeldOut {
  struct View {
    double cut, leaves, share;
  };
  double tau = 0;
  double cut = 0, leaves = 0;  // means; leaves: every one is drawn
  double share = 0;            // mean
  std::vector<View> views;
};
struct OptimizeSummary {
  uint32_t pictures = 0;
  double shrink = 1;  // by which extents were multiplied at the end
  // At the same τ. Of parts, the mean by their leaves, and `after` is at what these τ became when
  // extents shrank.
  std::vector<HeldOut> before, after;
  // Of the view that gained least at that τ, dB; below 0 where it lost. Against as many nodes
  // before: between the cuts that were looked at, by the logarithm of their shares.
  double least_gain(size_t of) const;
};

// Changes the merged Gaussians of a clustered tree and its extents; leaves stay as they are. With a
// number of pictures the same scene on the same device gives the same bytes, however often this was
// stopped. At the end all extents shrink by one factor, as far as a cut's held-out pictures at the
// default τ stay within half a dB of every leaf's (of parts: by the mean of theirs). Where there is
// not the memory for all at once, parts learn one after another (part.h). kept: a file in which
// what was learned is kept now and then, and from which this goes on, `kept`.0, .1 and so on of
// parts; whoever calls removes them (checkpoint.h's kept_files()). Progress counts pictures, of
// each part anew. Throws Error(refused_input) where the file is of another scene or was altered,
// Error(unsupported) for another kind of tree or where the backend has no trainer,
// Error(over_budget), Error(io).
OptimizeSummary optimize_nodes(BakedScene& baked, const OptimizeGoal& goal, Backend& backend,
                               const std::string& kept, Workers& workers,
                               const Progress& progress = {});

// Bytes that this takes of the host's memory beside the scene, about: where all learn at once, and
// in the smallest parts.
uint64_t bytes_to_optimize(uint64_t gaussians, int sh_degree);
uint64_t least_bytes_to_optimize(uint64_t gaussians, int sh_degree);

}  // namespace voyager
