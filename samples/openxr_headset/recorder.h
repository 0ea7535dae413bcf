#pragma once
// --readback: NNNN_L.png and NNNN_R.png of each frame shown, with quad views NNNN_L_inner.png and
// NNNN_R_inner.png too, and cameras.json with the poses and frusta they were drawn with, left and
// right by turns, for `voyager render --stereo --all`.
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "camera.h"
#include "runtime.h"

namespace host {

class Recorder {
 public:
  // Makes the folder. An earlier recording in it, its cameras.json and the pictures which that
  // names, is removed when the first frame of this one is there. Throws Failure(kBadUsage) for a
  // cameras.json that is not a recording's, and where one of its files is one of the `inputs`.
  Recorder(std::string folder, const std::vector<std::string>& inputs);

  // views: as many in every frame. Its pictures may come later. A frame that was lost before it was
  // shown is added again.
  void add(uint64_t frame, const std::vector<Camera>& views);
  void write_picture(uint64_t frame, size_t view, VkExtent2D extent,
                     std::span<const uint8_t> rgba) const;
  void write_cameras() const;  // none where no frame was added

 private:
  std::string folder_;
  std::vector<std::string> earlier_;  // files of an earlier recording
  nlohmann::json cameras_ = nlohmann::json::array();
};

}  // namespace host
