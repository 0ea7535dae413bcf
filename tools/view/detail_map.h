#pragma once
// The cut of a frame as a flat scene of its own, each Gaussian in the colour of its extent: where
// detail is left out shows. It is made from the file, on a thread of its own.
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/math/vec.h"
#include "tools/view/loaded_scene.h"
#include "tools/view/refusal.h"

namespace voyager::view {

// Of a merged Gaussian with this extent, and of one of the scene's own (0 metres): code values.
Vec3f detail_colour(float extent);
// What the scale of colours goes from and to, metres.
inline constexpr float kFinestExtent = 0.01f, kCoarsestExtent = 10;

class DetailJob {
 public:
  // nodes: of the cut, ascending. footprint: square metres that each Gaussian is widened by, as
  // antialiasing does. The device must outlive it.
  DetailJob(const voy::Device& device, std::string file, std::vector<uint32_t> nodes,
            double footprint);
  ~DetailJob();
  DetailJob(const DetailJob&) = delete;
  DetailJob& operator=(const DetailJob&) = delete;

  bool done() const { return done_; }
  // Once done: nothing where it failed, and why.
  std::optional<LoadedScene> take() { return std::exchange(result_, std::nullopt); }
  const Refusal& error() const { return error_; }

 private:
  void run();

  const voy::Device& device_;
  const std::string file_;
  const std::vector<uint32_t> nodes_;
  const double footprint_;
  std::optional<LoadedScene> result_;
  Refusal error_;
  std::atomic<bool> stopped_ = false, done_ = false;
  std::thread thread_;
};

}  // namespace voyager::view
