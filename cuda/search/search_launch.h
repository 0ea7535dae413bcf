#pragma once
// The kernels of a search, launched on a stream. None waits for the host.
#include <cuda_runtime_api.h>

#include "cuda/scene/gaussian_view.h"
#include "cuda/scene/sweep_tree.h"
#include "cuda/search/cut_state.h"
#include "runtime/select/cut.h"

namespace voyager::cuda {

// What a frame's kernels share.
struct SearchFrame {
  TreeView tree;
  StateView state;
  Sight sight;
  uint32_t reference;  // of this frame, for what is visited in it
  unsigned multiprocessors;
  cudaStream_t stream;
};

// From References.
struct Travels {
  Travel of[kReferences];
  Travel retired;
};

// cut_check.cu. Lists the open subtrees whose slack has run out, or all. now: References'.
void launch_check(const SearchFrame& frame, const Travels& travels, const Journey& now);
void launch_list_open(const SearchFrame& frame);
// cut_temporal.cu, after one of those. Visits what is listed; where that is more than max_due,
// streams in its stead, which is decided on the device.
void launch_temporal(const SearchFrame& frame, uint32_t max_due);
// cut_relink.cu, before one of those. What linking has changed, by subtree; both where kernels
// read them.
struct Relinked {
  const uint32_t* unlinked;  // to which nothing led for some time, or does now
  const uint32_t* changed;   // with a record that is blocked now, or no longer is
  uint32_t unlinked_count, changed_count;
};
void launch_relink(const SearchFrame& frame, const Relinked& relinked);
// The search starts from nothing: where it is not known what has changed.
void launch_forget(const SearchFrame& frame);
// cut_streaming.cu
void launch_streaming(const SearchFrame& frame);
// cut_place.cu, cut_emit.cu: the cut list, ascending.
void launch_place(const SearchFrame& frame);
void launch_emit(const SearchFrame& frame);
// cut_bounds.cu: of the rows that launch_emit() wrote.
void launch_bound(const StateView& state, const GaussianView& gaussians, bool weights,
                  unsigned multiprocessors, cudaStream_t stream);
// weights.cu. weights: by place.
void launch_weigh(const WeightSource& from, const StateView& state, float* weights,
                  unsigned multiprocessors, cudaStream_t stream);

// cut_exhaustive.cu. Into nodes[] (room for every node) and *count; scratch as
// exhaustive_scratch_bytes() says.
struct ExhaustiveTree {
  const NodeRecord* records;
  const uint32_t* parent;
  uint32_t size;
  float blend_share;  // LodTree's
};
size_t exhaustive_scratch_bytes(const ExhaustiveTree& tree);
void launch_exhaustive(const ExhaustiveTree& tree, const Sight& sight, void* scratch,
                       size_t scratch_bytes, uint32_t* nodes, uint32_t* count, cudaStream_t stream);
void launch_weights(const ExhaustiveTree& tree, const Sight& sight, const uint32_t* nodes,
                    const uint32_t* count, float* weights, unsigned multiprocessors,
                    cudaStream_t stream);

// cut_sweep.cu. What a view keeps of its cut.
struct SweepCounters {
  uint32_t cut_size, next_tile, entered, left;
};
struct SweepState {
  float* sizes;               // of each record, of this run
  uint32_t* cut;              // bits: nodes in the last cut
  unsigned long long* tiles;  // sweep_tiles(); 0 before the first run
  SweepCounters* counters;
  uint32_t* nodes;  // the cut, ascending; room for every leaf
  float* weights;   // of each; may be null
};
size_t sweep_tiles(uint32_t nodes);
// run: from 1 to 2^31 - 1, another each time. The tree has a node.
void launch_sweep(const SweepView& tree, const SweepState& state, const Sight& sight, uint32_t run,
                  unsigned multiprocessors, cudaStream_t stream);

}  // namespace voyager::cuda
