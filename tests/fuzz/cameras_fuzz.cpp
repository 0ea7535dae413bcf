// Any bytes as a cameras.json: cameras that can be drawn, or one line that says what is wrong.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "runtime/base/error.h"
#include "tests/fuzz/memory_limit.h"
#include "tests/fuzz/scratch_folder.h"
#include "tools/cameras.h"

namespace voyager::fuzz {
namespace {

using tools::Camera;

bool is_finite(const VoyFrustum& f) {
  return std::isfinite(f.left) && std::isfinite(f.right) && std::isfinite(f.up) &&
         std::isfinite(f.down);
}

void check(const Camera& camera) {
  double length = 0;
  for (const double q : camera.pose.orientation) length += q * q;
  if (!(std::fabs(length - 1) < 1e-9)) std::abort();
  for (const double p : camera.pose.position)
    if (!std::isfinite(p)) std::abort();
  if (!is_finite(camera.frustum())) std::abort();
}

void read(const std::string& path) {
  try {
    for (const Camera& camera : tools::read_cameras(path)) check(camera);
  } catch (const Error& error) {
    const std::string text = error.what();
    const bool one_line = text.find('\n') == std::string::npos && text.size() < 1000;
    if (error.code() != ErrorCode::refused_input || !one_line) std::abort();
  }
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string path = voyager::fuzz::scratch_file("cameras.json");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const voyager::fuzz::MemoryLimit limit(size);
  voyager::fuzz::read(path);
  return 0;
}
