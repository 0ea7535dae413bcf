#include "tools/report/report_plan.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "tools/cameras.h"
#include "tools/frame_path.h"

namespace voyager::tools {
namespace {

struct Frames {
  size_t path, compared, timed;  // at most; timed: at least, by repeats
  size_t slow;
};

Frames frames_of(ReportExtent extent) {
  if (extent == ReportExtent::quick) return {16, 2, 16, 3};
  if (extent == ReportExtent::full) return {600, 8, 200, 9};
  return {60, 3, 40, 5};
}

// Each of `spread` frames, and the one behind it where there is one.
std::vector<size_t> compared_frames(size_t path, size_t spread) {
  std::vector<size_t> compared;
  for (const size_t i : spread_indices(path, spread)) {
    if (compared.empty() || compared.back() < i) compared.push_back(i);
    if (i + 1 < path) compared.push_back(i + 1);
  }
  return compared;
}

}  // namespace

ReportPlan report_plan(const std::string& file, const ImageSize& size, ReportExtent extent) {
  const Frames frames = frames_of(extent);
  std::vector<Camera> cameras = read_cameras(file);
  if (cameras.empty())
    throw Error(ErrorCode::refused_input, file + ": found no camera, expected one or more");
  cameras.resize(std::min(cameras.size(), frames.path));
  if (size.width != 0)
    for (Camera& camera : cameras) camera = camera.resized(size.width, size.height);
  ReportPlan plan;
  plan.path = frame_path(cameras, 0);
  plan.repeats = std::max<size_t>(1, frames.timed / plan.path.size());
  plan.compared = compared_frames(plan.path.size(), frames.compared);
  plan.slow_frames = frames.slow;
  plan.first_compared = cameras[plan.compared[0]];
  return plan;
}

ReportPlan curve_plan(const std::string& file, const ImageSize& size, ReportExtent extent) {
  constexpr size_t kViews = 4;
  ReportPlan plan = report_plan(file, size, extent);
  const size_t path = plan.path.size(), least = std::min(path, kViews);
  for (size_t spread = frames_of(extent).compared; plan.compared.size() < least; ++spread)
    plan.compared = compared_frames(path, spread);
  return plan;
}

}  // namespace voyager::tools
