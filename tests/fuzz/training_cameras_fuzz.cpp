// Any bytes as the cameras of a training: cameras of finite numbers, or one line that says what is
// wrong. A line of ===== parts COLMAP's cameras from its images.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "runtime/base/error.h"
#include "tests/fuzz/memory_limit.h"
#include "tests/fuzz/scratch_folder.h"
#include "tools/training_cameras.h"

namespace voyager::fuzz {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const TrainingCamera& camera) {
  for (int i = 0; i < 3; ++i) {
    require(std::fabs(camera.position[i]) < 1e18);
    for (int k = 0; k < 3; ++k) {
      const Vec3d* row = camera.world_to_view.row;
      require(std::fabs(dot(row[i], row[k]) - (i == k ? 1 : 0)) < 1e-2);
    }
  }
  require(std::isfinite(camera.fx) && camera.fx > 0 && std::isfinite(camera.fy) && camera.fy > 0);
  require(std::isfinite(camera.cx) && std::isfinite(camera.cy));
  require(camera.width > 0 && camera.height > 0);
}

void read(const std::string& path) {
  try {
    for (const TrainingCamera& camera : tools::read_training_cameras(path)) check(camera);
  } catch (const Error& error) {
    const std::string text = error.what();
    require(text.find('\n') == std::string::npos && text.size() < 1000);
    require(error.code() == ErrorCode::refused_input);
  }
}

std::string written(const char* name, std::string_view bytes) {
  const std::string path = scratch_file(name);
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr std::string_view kBetween = "\n=====\n";
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const size_t end = bytes.find(kBetween);
  if (end != std::string_view::npos)
    voyager::fuzz::written("images", bytes.substr(end + kBetween.size()));
  else
    voyager::fuzz::written("images", "");
  const std::string path = voyager::fuzz::written("cameras", bytes.substr(0, end));
  const voyager::fuzz::MemoryLimit limit(size);
  voyager::fuzz::read(path);
  return 0;
}
