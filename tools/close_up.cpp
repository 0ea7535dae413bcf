#include "tools/close_up.h"

#include <algorithm>
#include <cmath>

#include "tools/frame_path.h"
#include "tools/statistics.h"

namespace voyager::tools {
namespace {

constexpr uint32_t kProbe = 96;    // pixels of a side of the picture that the depth is taken from
constexpr double kNearest = 0.1;   // share of its depths that may be nearer
constexpr double kSideways = 0.1;  // metres a step

// Looks for the surface in front of a camera.
class Probe {
 public:
  explicit Probe(const FrameMaker& maker)
      : view_(maker.scene, maker.backend, {}, std::pmr::get_default_resource(), maker.workers),
        depth_(size_t{kProbe} * kProbe) {}

  // Metres along the view; infinite where there is none.
  double distance(const Camera& from) {
    FrameInput frame = frame_input(from.resized(kProbe, kProbe), 3);
    Image image;
    image.width = kProbe;
    image.height = kProbe;
    image.depth = depth_.data();
    image.depth_pitch = kProbe * sizeof(float);
    frame.eyes[0].depth_wanted = true;
    view_.render(frame, image);
    std::vector<double> middle;
    for (uint32_t y = kProbe / 3; y < kProbe - kProbe / 3; ++y)
      for (uint32_t x = kProbe / 3; x < kProbe - kProbe / 3; ++x)
        middle.push_back(double{depth_[size_t{y} * kProbe + x]});
    return percentile(middle, kNearest);
  }

 private:
  View view_;
  std::vector<float> depth_;
};

void move(std::vector<Camera>& eyes, const Vec3d& by) {
  for (Camera& eye : eyes)
    for (int k = 0; k < 3; ++k) eye.pose.position[k] += by[k];
}

}  // namespace

std::vector<Camera> close_up_cameras(const FrameMaker& maker, std::span<const Camera> start,
                                     size_t steps) {
  Probe probe(maker);
  std::vector<Camera> eyes(start.begin(), start.end()), path;
  const double far = probe.distance(eyes[0]) - kCloseUp;
  if (!std::isfinite(far)) return {};
  const Mat3d axes = frame_input(eyes[0], 0).eyes[0].camera.world_to_view;
  const Vec3d &right = axes.row[0], &forward = axes.row[2];
  const size_t approach = std::max<size_t>(1, steps / 2);
  for (size_t i = 0; i < steps; ++i) {
    if (i > 0 && i < approach) move(eyes, far / static_cast<double>(approach - 1) * forward);
    if (i >= approach) {
      move(eyes, kSideways * right);
      // Neither into a gap nor through what stands out at once.
      const double off = probe.distance(eyes[0]) - kCloseUp;
      move(eyes, std::clamp(off, -kSideways, kSideways) * forward);
    }
    path.insert(path.end(), eyes.begin(), eyes.end());
  }
  return path;
}

}  // namespace voyager::tools
