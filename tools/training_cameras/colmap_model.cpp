#include "tools/training_cameras/colmap_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/math/screen_size.h"
#include "tools/training_cameras/byte_window.h"

namespace voyager::tools {
namespace {

// In the order of their numbers.
constexpr std::array<ColmapModel, 18> kModels{{{"SIMPLE_PINHOLE", 1, 3},
                                               {"PINHOLE", 2, 4},
                                               {"SIMPLE_RADIAL", 1, 4},
                                               {"RADIAL", 1, 5},
                                               {"OPENCV", 2, 8},
                                               {"OPENCV_FISHEYE", 2, 8},
                                               {"FULL_OPENCV", 2, 12},
                                               {"FOV", 2, 5},
                                               {"SIMPLE_RADIAL_FISHEYE", 1, 4},
                                               {"RADIAL_FISHEYE", 1, 5},
                                               {"THIN_PRISM_FISHEYE", 2, 12},
                                               {"RAD_TAN_THIN_PRISM_FISHEYE", 2, 16},
                                               {"SIMPLE_DIVISION", 1, 4},
                                               {"DIVISION", 2, 5},
                                               {"SIMPLE_FISHEYE", 1, 3},
                                               {"FISHEYE", 2, 4},
                                               {"EUCM", 2, 6},
                                               {"EQUIRECTANGULAR", 0, 2}}};

const ColmapModel& with_focal_length(const std::string& place, const ColmapModel& model) {
  if (model.focals == 0)
    refuse_cameras(place, fmt::format("camera model {}", model.name),
                   "one that has a focal length");
  return model;
}

}  // namespace

const ColmapModel& colmap_model(const std::string& place, int32_t number) {
  if (number < 0 || static_cast<size_t>(number) >= kModels.size())
    refuse_cameras(place, fmt::format("camera model {}", number),
                   fmt::format("a number from 0 to {}", kModels.size() - 1));
  return with_focal_length(place, kModels[static_cast<size_t>(number)]);
}

const ColmapModel& colmap_model(const std::string& place, std::string_view name) {
  const auto found = std::ranges::find(kModels, name, &ColmapModel::name);
  if (found == kModels.end())
    refuse_cameras(place, fmt::format("camera model {}", excerpt(name)),
                   "one of COLMAP's, such as PINHOLE");
  return with_focal_length(place, *found);
}

void add_lens(ColmapLenses& lenses, const std::string& place, uint32_t id, const ColmapModel& model,
              uint64_t width, uint64_t height, std::span<const double> parameters) {
  if (std::min(width, height) < 1 || std::max(width, height) > kLargestTrainingSide)
    refuse_cameras(place, fmt::format("a picture of {} x {} pixels", width, height),
                   fmt::format("1 to {} a side", kLargestTrainingSide));
  const double fx = parameters[0], fy = parameters[model.focals - 1];
  if (!(fx > 0 && fy > 0 && std::isfinite(fx) && std::isfinite(fy)))
    refuse_cameras(place, fmt::format("focal lengths of {} and {}", fx, fy),
                   "finite numbers above 0");
  const double cx = parameters[model.focals], cy = parameters[model.focals + 1];
  if (!(std::isfinite(cx) && std::isfinite(cy)))
    refuse_cameras(place, fmt::format("a principal point at {}, {}", cx, cy), "finite numbers");
  const ColmapLens lens{
      fx, fy, cx, cy, static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
  if (!lenses.emplace(id, lens).second)
    refuse_cameras(place, fmt::format("camera {} for the second time", id), "it once");
}

TrainingCamera colmap_camera(const ColmapLenses& lenses, const std::string& place, uint32_t lens,
                             std::span<const double, 7> pose) {
  const auto found = lenses.find(lens);
  if (found == lenses.end())
    refuse_cameras(place, fmt::format("an image of camera {}", lens),
                   fmt::format("one of the {} in the file of cameras", lenses.size()));
  const double largest =
      std::max({std::fabs(pose[0]), std::fabs(pose[1]), std::fabs(pose[2]), std::fabs(pose[3])});
  if (!std::ranges::all_of(pose, [](double x) { return std::isfinite(x); }) || largest == 0)
    refuse_cameras(place, "a pose with a zero quaternion, an infinity or a NaN",
                   "a rotation and a translation");
  const ColmapLens& l = found->second;
  TrainingCamera camera{{}, {}, l.fx, l.fy, l.cx, l.cy, l.width, l.height};
  camera.world_to_view = rotation(
      normalise(Quatd{pose[0] / largest, pose[1] / largest, pose[2] / largest, pose[3] / largest}));
  for (int axis = 0; axis < 3; ++axis)
    camera.position =
        camera.position - pose[4 + static_cast<size_t>(axis)] * camera.world_to_view.row[axis];
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::fabs(camera.position[axis]) < double{kMaxCoordinate}))
      refuse_cameras(place, "a camera 1e18 or more away from the origin", "one that is nearer");
  return camera;
}

}  // namespace voyager::tools
