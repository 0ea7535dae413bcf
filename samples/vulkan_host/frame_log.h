#pragma once
// What each frame took, as JSON.
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "voyager_layer.h"

namespace host {

class FrameLog {
 public:
  // path: empty for none.
  explicit FrameLog(std::string path) : path_(std::move(path)) {}

  void add(const VoyagerLayer* voyager);  // NULL: a frame without splats
  void write(const Device& device, const VoyagerLayer& voyager) const;

 private:
  std::string path_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  nlohmann::json frames_ = nlohmann::json::array();
};

}  // namespace host
