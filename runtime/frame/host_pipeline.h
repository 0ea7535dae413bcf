#pragma once
// A pipeline whose stages run on the host, one after the other.
#include "runtime/frame/backend.h"

namespace voyager {

class HostPipeline : public Pipeline {
 public:
  void draw(const FrameInput& frame, const Image& image, FrameStats& stats) final;
  void resolve(const FrameInput& frame, const Image& image, FrameStats& stats) final;

 protected:
  virtual void search(const FrameInput& frame) = 0;   // and interpolation weights
  virtual void project(const FrameInput& frame) = 0;  // and the α-filter's culling
  virtual void sort(const FrameInput& frame) = 0;     // splats by depth
  virtual void bin(const FrameInput& frame) = 0;      // splats to tiles, in that order
  virtual void rasterize(const FrameInput& frame) = 0;
  virtual void write(const FrameInput& frame, const Image& image) = 0;  // the host's image
  // Counters of the frame just run.
  virtual void collect(FrameStats& stats) const = 0;
};

}  // namespace voyager
