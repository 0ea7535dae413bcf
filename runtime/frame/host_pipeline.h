#pragma once
// A pipeline whose stages run on the host, one after the other.
#include "runtime/frame/backend.h"

namespace voyager {

class HostPipeline : public Pipeline {
 public:
  void draw(const FrameInput& frame, FrameStats& stats) final;
  void resolve(const FrameInput& frame, FrameStats& stats) final;

 protected:
  virtual void search(const FrameInput& frame) = 0;   // and interpolation weights
  virtual void project(const FrameInput& frame) = 0;  // for all eyes; and the α-filter's culling
  // Of an eye, one after the other.
  virtual void sort(size_t eye) = 0;                          // splats by depth
  virtual void bin(const FrameInput& frame, size_t eye) = 0;  // splats to tiles, in that order
  virtual void rasterize(const FrameInput& frame, size_t eye) = 0;
  virtual void write(const FrameInput& frame, size_t eye) = 0;  // the host's image
  // Adds the counters of the eye just rasterized, and of the frame just run.
  virtual void collect_eye(FrameStats& stats) const = 0;
  virtual void collect(FrameStats& stats) const = 0;
};

}  // namespace voyager
