#pragma once
// What covers a view's tiles, from frame to frame.
#include <cuda_runtime_api.h>

#include <vector>

#include "cuda/device/buffer.h"
#include "cuda/splat/splats.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

// From an eye's image to that of its camera in the frame before.
struct EyeMotion {
  float to_before[9];  // of tiles, homogeneous: what is far away; its third is z before over z now
  float around;        // tiles that may be seen in one, half a side, by what is far away
  float parallax;      // and more by parallax/z
  float moved;         // metres
};
EyeMotion eye_motion(const Camera& now, const Camera& before);

// As kernels take it.
struct OcclusionFrame {
  FrameTiles tiles;
  uint32_t* ends;  // SplatView::ends
  EyeMotion motion[kMaxEyes];
  TileLimits limits;  // where in bits
  uint32_t* bits;
};

// occlusion.cu
void launch_occlusion_guess(const OcclusionFrame& frame, cudaStream_t stream);
// first: limits of the first pass; splats: of the second, whose counters get the tiles.
void launch_occlusion_rest(const OcclusionFrame& frame, const uint32_t* first,
                           const SplatView& splats, cudaStream_t stream);

// Whether limits pay: by frames of either kind, now and then one of the other. By numbers of pairs,
// which do not depend on the machine.
class OcclusionChoice {
 public:
  explicit OcclusionChoice(Occlusion setting) : setting_(setting) {}

  bool possible() const { return setting_ != Occlusion::off; }
  // For the next frame.
  bool next();
  // Of a frame that has ended: the pairs that it made, in both passes.
  void learn(bool limited, uint64_t pairs);

 private:
  Occlusion setting_;
  bool pays_ = false;
  unsigned since_other_ = 0;  // frames since one of the other kind
  uint64_t plain_pairs_ = 0;  // of the last frame without limits
};

class OcclusionState {
 public:
  // Whether there is room for the tiles.
  bool fits(const FrameTiles& tiles) const;
  // Makes it. Nothing on the device uses the buffers. Throws Error.
  void fit(const FrameTiles& tiles);
  // Before a frame is drawn: launches its limits where they are wanted and there are some. ends: as
  // the frame before left them.
  void begin(bool wanted, const FrameInput& frame, const FrameTiles& tiles, uint32_t* ends,
             cudaStream_t stream);
  // The ends of the frame before are no longer there.
  void forget() { before_.clear(); }

  bool limited() const { return first_.bits != nullptr; }
  // Of the first pass; none where the frame has no limits.
  const TileLimits& first() const { return first_; }
  // Launches those of the second.
  TileLimits second(const SplatView& splats, cudaStream_t stream) const;

 private:
  OcclusionFrame work(const FrameTiles& tiles, uint32_t* ends, bool second) const;

  Buffer<uint32_t> bits_;  // of both passes
  std::vector<Camera> before_;
  TileLimits first_;
};

}  // namespace voyager::cuda
