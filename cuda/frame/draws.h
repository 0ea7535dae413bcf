#pragma once
// What a view draws of a scene: the cut that its search finds, or every Gaussian.
#include <memory>

#include "cuda/search/search.h"
#include "cuda/splat/splat_launch.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class Draws {
 public:
  virtual ~Draws() = default;
  // Launches the search. gaussians: the instance's. Throws Error(damaged_chunk) where the frame
  // needs a node that is not there.
  virtual void update(const CutQuery& query, const GaussianView& gaussians,
                      cudaStream_t stream) = 0;
  virtual DrawView view() const = 0;
  // Launches the weights, where there are any and view() does not tell what to find them from.
  virtual void weigh(cudaStream_t) {}
  // As CutSearch has it.
  virtual void end_frame(cudaStream_t) noexcept {}
  // What collect() needs of the last frame: report_bytes() in pinned memory, copied on the
  // stream.
  virtual size_t report_bytes() const = 0;
  virtual void report(void* into, cudaStream_t stream) const = 0;
  // Adds a frame's counters.
  virtual void collect(const void* report, FrameStats& stats) const = 0;
  virtual bool counts_changes() const = 0;
  // Of the last frame, whose work is done.
  virtual void read_cut(std::pmr::vector<uint32_t>& cut) = 0;
};

// search: of a scene with a tree whose cut is drawn. Throws Error(unsupported) for what
// check_detail() refuses.
std::unique_ptr<Draws> create_draws(const Scene& scene, Lod lod, std::unique_ptr<CutSearch> search);

}  // namespace voyager::cuda
