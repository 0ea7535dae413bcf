#pragma once
// The boundary behind which merged Gaussians learn what they stand for: pictures of a cut are
// compared with the truth of METHOD §12, and what the cut holds moves down the gradient of the
// root mean square error. Leaves never change.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "runtime/frame/backend.h"
#include "runtime/stages/learn.h"

namespace voyager {

// A picture to learn from. samples: of the truth, along each side of a pixel.
struct TrainingView {
  Camera camera;
  double tau = 3;
  uint32_t samples = 4;
};

// What a view's truth depends on. Leaves never change, so that one truth serves many cuts.
struct TruthOf {
  Camera camera;
  uint32_t samples = 0;
  bool operator==(const TruthOf&) const = default;
};
inline TruthOf truth_of(const TrainingView& view) {
  return {view.camera, view.samples};
}

// Of the picture whose samples × samples pixels are a pixel's truth.
inline Camera truth_camera(const TrainingView& view) {
  Camera camera = view.camera;
  camera.width *= view.samples, camera.height *= view.samples;
  camera.fx *= view.samples, camera.fy *= view.samples;
  camera.cx *= view.samples, camera.cy *= view.samples;
  return camera;
}

// Of a picture against the truth.
struct TrainingError {
  double squares = 0;  // summed over pixels and channels; colours are from 0 to 1
  uint32_t cut = 0;    // nodes, in view or not
};

// What a step's squared error is multiplied by. The gradient is then that of the root mean square
// error: pictures of coarse cuts, whose errors are large, count more than by the dB that they gain,
// and those of fine cuts more than by their squares (bench/NOTES.md). At 30 dB the mean of what
// comes out is 1, the unit that AdamStep::kNegligible is of.
inline double loss_weight(const TrainingView& view, double squares) {
  constexpr double kLeastMean = 1e-6, kUsualMean = 1e-3;  // 60 and 30 dB
  const double mean = squares / (3.0 * view.camera.width * view.camera.height);
  return 1 / std::sqrt(kUsualMean * std::max(mean, kLeastMean));
}

// By which a picture's error falls to a node of the cut, shared by weight in each pixel.
struct NodeError {
  uint32_t node;
  float squares;
};

// All that changes. A row is a merged node's, in the order of ids: numbers_of() numbers
// (runtime/stages/learn.h).
struct TrainingState {
  std::vector<float> values;         // mean, scale, rotation, log opacity, coefficients [k][rgb]
  std::vector<float> opacities;      // a row's
  std::vector<float> first, second;  // Adam's moments
  std::vector<uint32_t> steps;       // a row's
  bool operator==(const TrainingState&) const = default;
};

// Not thread-safe. The same calls on the same device give the same bits.
class NodeTrainer {
 public:
  virtual ~NodeTrainer() = default;
  // Moves what the view's cut shows; the error is that before.
  virtual TrainingError step(const TrainingView& view, const LearningRates& rates) = 0;
  virtual TrainingError error(const TrainingView& view) = 0;
  // Of every leaf, drawn as a picture of the view's size is.
  virtual TrainingError error_of_leaves(const TrainingView& view) = 0;
  // Of the merged nodes of the view's cut, ascending.
  virtual std::vector<NodeError> node_errors(const TrainingView& view) = 0;
  // By node, as LodTree's.
  virtual void set_extents(const std::vector<float>& extents) = 0;
  virtual TrainingState state() const = 0;
  virtual void set_state(const TrainingState& state) = 0;
};

}  // namespace voyager
