#pragma once
// One view of one scene through the public ABI, with the images it renders to.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/cameras.h"
#include "voyager/voyager.hpp"
#include "voyager/voyager_experiment.h"

namespace voyager::tools {

struct RenderChoices {
  VoyBackend backend = VOY_BACKEND_AUTO;
  VoyLod lod = VOY_LOD_AUTO;
  double tau = 3;
  double time_budget = 0;  // milliseconds; 0: tau is fixed
  VoyExperiment experiment = VOY_EXPERIMENT_INIT;
  bool slack = true;  // off: VOY_SEARCH_TEMPORAL visits all of the last cut
  VoyAntialias antialias = VOY_ANTIALIAS_ON;
  uint32_t supersample = 1;  // samples a pixel along each axis: METHOD §12's truth where above 1
  float background[3] = {0, 0, 0};  // code values, 0 to 1
  bool floats = false;              // RGBA32F instead of RGBA8
  bool depth = false;
  uint32_t eyes = 1;  // of each frame
  double budget = 0;  // MB of scene data where it is drawn; 0: no limit
  bool streamed = false;
  bool wait_resident = false, keep_going = false;  // of a streamed scene
  const double* start = nullptr;                   // of one: where the first frame looks from
};

// Of an eye.
struct RenderedImage {
  std::vector<uint8_t> rgba8;  // or, with RenderChoices::floats,
  std::vector<float> rgba32f;
  std::vector<float> depth;
};

// The library's log, as it goes to standard error. Until describe(), warnings wait, so that an
// error before that is the only line.
struct RendererLog {
  bool waits = true;
  std::vector<std::string> warnings;
};

class Renderer {
 public:
  // No camera may be larger than max_width x max_height.
  Renderer(const std::string& scene, const RenderChoices& choices, uint32_t max_width,
           uint32_t max_height);

  // One an eye.
  void render(std::span<const Camera> cameras);

  // Of the last frame.
  const RenderedImage& image(size_t eye) const { return images_[eye]; }
  bool has_tree() const { return scene_.info().storage != VOY_SCENE_STORAGE_FLAT; }
  bool draws_cut() const { return choices_.lod != VOY_LOD_ALL_LEAVES && has_tree(); }
  std::vector<uint32_t> cut() const { return view_.cut(); }
  VoyFrameStats stats() const { return view_.stats(); }
  // That found the last frame's cut.
  VoySearch search() const;
  std::vector<VoyOmission> omissions() const { return view_.omissions(); }
  std::string device_name() const { return device_.capabilities().deviceName; }
  // Says what draws, and passes the warnings on.
  void describe() const;

 private:
  bool samples() const { return choices_.supersample > 1; }
  voy::Target create_target(const Camera& camera, RenderedImage& image) const;
  void average(const Camera& camera, RenderedImage& image) const;

  RenderChoices choices_;
  std::unique_ptr<RendererLog> log_ = std::make_unique<RendererLog>();
  voy::Device device_;
  voy::Scene scene_;
  voy::View view_;
  std::vector<RenderedImage> images_;
};

}  // namespace voyager::tools
