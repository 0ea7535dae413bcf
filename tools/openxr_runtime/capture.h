#pragma once
// The frames that the application showed, as files: NNNN_L.png, NNNN_R.png, with quad views
// NNNN_L_inner.png and NNNN_R_inner.png, depth where it gave some, and a cameras.json of the poses
// and fields of view that it showed them with.
#include <string>
#include <vector>

#include "script.h"

namespace test_runtime {

struct ViewImage {
  Pose in_root;  // of the eye, in LOCAL before any recentring
  XrFovf fov;
  XrExtent2Di extent;
  std::vector<uint8_t> rgb;  // rows from the top
  std::vector<float> depth;  // metres; empty where the layer had none
  XrExtent2Di depth_extent = {0, 0};
};

class Capture {
 public:
  // folder "" captures nothing.
  Capture(std::string folder, Ranges frames, const Pose& root_in_scene);

  bool wants(int64_t frame) const { return !folder_.empty() && contains(frames_, frame); }
  // Writes the images, and gives the report's entry.
  nlohmann::ordered_json add(const std::vector<ViewImage>& views, int64_t frame, XrTime time);
  void write_cameras() const;

 private:
  nlohmann::ordered_json camera(const ViewImage& view, const std::string& name) const;

  std::string folder_;
  Ranges frames_;
  Pose root_in_scene_;
  int count_ = 0;
  nlohmann::ordered_json cameras_ = nlohmann::ordered_json::array();
};

}  // namespace test_runtime
