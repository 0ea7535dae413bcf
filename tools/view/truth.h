#pragma once
// How far a picture is from METHOD §12's truth: every leaf, with many samples a pixel.
#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tools/cameras.h"
#include "tools/view/refusal.h"

namespace voyager::view {

struct TruthRequest {
  std::string file;           // of a scene with a tree, or a flat one
  tools::Camera camera;       // of the picture
  std::vector<uint8_t> rgba;  // the picture
  VoyBackend backend = VOY_BACKEND_AUTO;
  float background[3] = {0, 0, 0};
};

struct TruthResult {
  double psnr = 0;  // dB; infinite where the pictures are equal
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> difference;  // RGBA: grey where they are equal, 8 times the difference
};

// Draws the truth on a thread of its own, from a device and a copy of the scene of its own.
class TruthJob {
 public:
  explicit TruthJob(TruthRequest request);
  // Waits until the step that is in progress has ended: the scene is loaded, or the truth drawn.
  ~TruthJob() {
    stop();
    thread_.join();
  }
  TruthJob(const TruthJob&) = delete;
  TruthJob& operator=(const TruthJob&) = delete;

  // The result is of no use any more.
  void stop() { stopped_ = true; }
  bool done() const { return done_; }
  // Once done: nothing where it failed or was stopped, and why it failed.
  const std::optional<TruthResult>& result() const { return result_; }
  const Refusal& error() const { return error_; }

 private:
  void run();

  const TruthRequest request_;
  std::optional<TruthResult> result_;
  Refusal error_;
  std::atomic<bool> stopped_ = false, done_ = false;
  std::thread thread_;
};

}  // namespace voyager::view
