#pragma once
// The boundary behind which backends live: Backend makes one Pipeline for each
// view, and frame/view.cpp runs its stages in order. A backend's pipeline holds
// the view's state (the last cut, scratch that is kept between frames).
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <string>

#include "runtime/base/workers.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/scene_search.h"
#include "runtime/math/vec.h"

namespace voyager {

enum class Lod { cut, all_leaves };
enum class Exponential { exact, ex2, lut };

// Resolved once, at view creation.
struct PipelineDesc {
  Lod lod = Lod::cut;
  Search search = Search::temporal;
  bool alpha_filter = true;
  Exponential exponential = Exponential::exact;
  uint32_t lut_size = 32;
};

// One eye's camera. View space: x right, y down, z forward (METHOD §5).
struct Camera {
  Vec3d eye{0, 0, 0};     // world, metres
  Mat3d world_to_view{};  // rows: right, down, forward
  double fx = 0, fy = 0;  // pixels
  double cx = 0, cy = 0;  // pixels, from the top left corner
  uint32_t width = 0, height = 0;
  double near_z = 0.2;  // metres
};

enum class ColorFormat { none, rgba8, rgba32f };

struct Image {
  ColorFormat format = ColorFormat::none;
  uint32_t width = 0, height = 0;
  void* color = nullptr;
  size_t color_pitch = 0;  // bytes
  float* depth = nullptr;
  size_t depth_pitch = 0;  // bytes
};

struct FrameInput {
  Camera camera;
  double tau = 3;
  Vec3f background{0, 0, 0};
  bool depth_wanted = false;
};

enum Stage { kSearch, kProject, kSort, kBin, kRasterize, kResolve, kStageCount };

struct FrameStats {
  uint64_t frame_index = 0;
  bool searched = false;
  Search search = Search::exhaustive;  // the one that ran, where one did
  bool changes_counted = false;        // entered and left are the search's own
  float tau_star = 0;
  Vec3f cut_centre{0, 0, 0};
  uint64_t nodes_total = 0, nodes_tested = 0, subtrees_visited = 0, chunks_read = 0, bytes_read = 0;
  uint64_t cut_size = 0, entered = 0, left = 0;
  uint64_t splats = 0, pairs_before = 0, pairs_after = 0;
  double milliseconds[kStageCount] = {};
  double total_milliseconds = 0;
};

class Pipeline {
 public:
  virtual ~Pipeline() = default;
  virtual void search(const FrameInput& frame) = 0;   // and interpolation weights
  virtual void project(const FrameInput& frame) = 0;  // and the α-filter's culling
  virtual void sort(const FrameInput& frame) = 0;     // splats by depth
  virtual void bin(const FrameInput& frame) = 0;      // splats to tiles, in that order
  virtual void rasterize(const FrameInput& frame) = 0;
  virtual void resolve(const FrameInput& frame, const Image& image) = 0;  // to the host's image
  // Counters of the frame just run.
  virtual void collect(FrameStats& stats) const = 0;
  // The last cut, ascending; empty where the view draws none.
  virtual const std::pmr::vector<uint32_t>& cut() const = 0;
};

class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string device_name() const = 0;
  virtual std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Scene> scene,
                                                    const PipelineDesc& desc,
                                                    std::pmr::memory_resource* memory,
                                                    Workers& workers) = 0;
  // The scene has a tree. Throws Error(unsupported) where the backend has no such search.
  virtual std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                                     const SearchDesc& desc,
                                                     std::pmr::memory_resource* memory,
                                                     Workers& workers) = 0;
};

inline constexpr uint32_t kMaxImageSide =
    16384;  // pixels; 2^20 tiles of 16 x 16 then fit a 32-bit key

}  // namespace voyager
