#pragma once
// The command line.
#include <voyager/voyager_vulkan.h>

#include <array>
#include <optional>
#include <string>

namespace host {

enum class Composite {
  limit,  // meshes hide splats before these are blended: the mesh's depth is a limit
  test,   // the finished image is tested against the mesh's depth, pixel by pixel
  none,   // the mesh alone
};

struct MeshPlace {
  std::array<double, 3> position;  // scene axes, metres
  double scale;
};

struct Options {
  std::string scene;
  std::string camera_file;  // or empty: in a window, the camera stands outside the bounds
  std::string output;       // a folder, with offscreen
  std::string stats_file;
  std::string mesh_file;  // or empty: the sample's own
  std::string device_name;
  bool offscreen = false;
  bool mesh = true;
  bool validation = false;
  bool write_depth = false;
  bool srgb = false;
  bool half_rate = false;  // every second frame is reprojected
  uint64_t frames = 0;     // 0: a window runs until it is closed
  // Neither: a window's display says how long a frame may take, and offscreen tau is 3.
  std::optional<double> tau, time_budget;  // pixels; milliseconds a frame of Voyager's
  double budget_megabytes = 0;             // of scene data, which is streamed then; 0: no limit
  Composite composite = Composite::limit;
  VoyDepthEncoding depth = VOY_DEPTH_ENCODING_REVERSED;
  VoyBackend backend = VOY_BACKEND_AUTO;
  VoyVulkanSharing sharing = VOY_VULKAN_SHARING_AUTO;
  VoyVulkanSync sync = VOY_VULKAN_SYNC_AUTO;
  std::optional<MeshPlace> mesh_place;  // or none: in the middle of the scene
};

// Nothing where --help was printed. Throws CLI::ParseError.
std::optional<Options> parse_options(int argc, char** argv);

}  // namespace host
