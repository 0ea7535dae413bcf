#pragma once
// What a frame draws of each of a view's instances, on the host.
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "runtime/frame/draw_list.h"

namespace voyager {

struct HostInstance {
  HostInstance(const std::shared_ptr<const Scene>& drawn, const PipelineDesc& desc,
               std::pmr::memory_resource* memory, Workers& workers)
      : scene(drawn), draws(drawn, desc.lod, desc.search, memory, workers) {}

  std::shared_ptr<const Scene> scene;
  DrawList draws;
  // Of the frame.
  std::array<Camera, kMaxEyes> cameras;  // in the scene's coordinates
  InstanceLook look;
  size_t first = 0;   // the place of the first item
  ShownChunks shown;  // for who draws to tell; none where nobody wants it
};

// Places are where items are projected to: they ascend with (instance, id), which breaks
// ties of depth.
class HostInstances {
 public:
  // grain: of places; an instance's first is a multiple of it.
  HostInstances(const Scenes& scenes, const PipelineDesc& desc, size_t grain,
                std::pmr::memory_resource* memory, Workers& workers);

  // As Pipeline has it.
  void set_scenes(const Scenes& scenes, std::span<const size_t> from);
  // Throws Error as DrawList does; the next call is right all the same.
  void update(const FrameInput& frame);

  // In their order, as the last update left them.
  const std::vector<std::unique_ptr<HostInstance>>& all() const { return all_; }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& nodes) const {
    all_[instance]->draws.read_cut(nodes);
  }
  // Of all instances.
  size_t places() const { return places_; }
  void collect(FrameStats& stats) const;

 private:
  PipelineDesc desc_;
  std::pmr::memory_resource* memory_;
  Workers& workers_;
  std::vector<std::unique_ptr<HostInstance>> all_;
  size_t grain_, places_ = 0;
};

}  // namespace voyager
