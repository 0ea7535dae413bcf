#pragma once
// One view of one scene through the public ABI, with the images it renders to.
#include <string>
#include <vector>

#include "tools/cameras.h"
#include "voyager/voyager.hpp"

namespace voyager::tools {

struct RenderChoices {
  VoyBackend backend = VOY_BACKEND_AUTO;
  VoyLod lod = VOY_LOD_CUT;
  double tau = 3;
  VoySearch search = VOY_SEARCH_TEMPORAL;
  bool slack = true;  // off: VOY_SEARCH_TEMPORAL visits all of the last cut
  VoyAlphaFilter alpha_filter = VOY_ALPHA_FILTER_ON;
  VoyExponential exponential = VOY_EXPONENTIAL_AUTO;
  uint32_t lut_size = 32;
  VoySplatting splatting = VOY_SPLATTING_OURS;
  float background[3] = {0, 0, 0};  // code values, 0 to 1
  bool floats = false;              // RGBA32F instead of RGBA8
  bool depth = false;
};

class Renderer {
 public:
  // No camera may be larger than max_width x max_height.
  Renderer(const std::string& scene, const RenderChoices& choices, uint32_t max_width,
           uint32_t max_height);

  void render(const Camera& camera);

  // Of the last frame.
  const std::vector<uint8_t>& rgba8() const { return rgba8_; }
  const std::vector<float>& rgba32f() const { return rgba32f_; }
  const std::vector<float>& depth() const { return depth_; }
  bool draws_cut() const;
  std::vector<uint32_t> cut() const { return view_.cut(); }
  VoyFrameStats stats() const { return view_.stats(); }
  std::vector<VoySceneNote> notes() const { return scene_.notes(); }
  std::string device_name() const { return device_.capabilities().deviceName; }

 private:
  voy::Target create_target(const Camera& camera);

  RenderChoices choices_;
  voy::Device device_;
  voy::Scene scene_;
  voy::View view_;
  std::vector<uint8_t> rgba8_;
  std::vector<float> rgba32f_, depth_;
};

}  // namespace voyager::tools
