#include "tools/report/report_plan.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "tools/cameras.h"
#include "tools/frame_path.h"

namespace voyager::tools {
namespace {

struct Frames {
  size_t path, compared, timed;  // at most; timed: at least, by repeats
};

Frames frames_of(ReportExtent extent) {
  if (extent == ReportExtent::quick) return {16, 2, 16};
  if (extent == ReportExtent::full) return {600, 8, 200};
  return {60, 3, 40};
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
  for (const size_t i : spread_indices(plan.path.size(), frames.compared)) {
    if (plan.compared.empty() || plan.compared.back() < i) plan.compared.push_back(i);
    if (i + 1 < plan.path.size()) plan.compared.push_back(i + 1);
  }
  return plan;
}

}  // namespace voyager::tools
