#pragma once
// What tests share: random clouds, a folder that vanishes, the real scenes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include "runtime/scene/gaussian_cloud.h"
#include "tests/support/needs.h"

namespace voyager::test {

class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "voyager-test-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// The folder that VOYAGER_SCENES names, else ../shared/scenes beside the checkout; "" if absent.
inline std::string scenes_folder() {
  const char* named = std::getenv("VOYAGER_SCENES");
  const std::filesystem::path folder =
      named ? std::filesystem::path(named)
            : std::filesystem::path(VOYAGER_SOURCE_DIR) / "../shared/scenes";
  return std::filesystem::exists(folder / "README.md") ? folder.string() : "";
}

#define VOYAGER_NEEDS_SCENES(folder)                         \
  const std::string folder = voyager::test::scenes_folder(); \
  if (folder.empty())                                        \
  VOYAGER_SKIP_WITHOUT(SCENES, "the real scenes are not here: set VOYAGER_SCENES to their folder")

// Gaussians of every shape around the origin; deterministic for a seed.
inline GaussianCloud random_cloud(size_t count, uint32_t seed, int sh_degree = 1,
                                  float spread = 10.0f) {
  std::mt19937 random(seed);
  const auto uniform = [&](float lo, float hi) {
    return lo + (hi - lo) * (static_cast<float>(random() >> 8) / 16777216.0f);
  };
  GaussianCloud cloud;
  cloud.sh_degree = sh_degree;
  cloud.native = {NativeSource::given, 0.05, kPixelVariance};  // parts of it have the same
  for (size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) cloud.position.push_back(uniform(-spread, spread));
    for (int k = 0; k < 3; ++k) cloud.log_scale.push_back(uniform(-6.0f, 0.0f));
    for (int k = 0; k < 4; ++k)
      cloud.rotation.push_back(uniform(-1.0f, 1.0f) + (k == 0 ? 1e-3f : 0.0f));
    cloud.opacity.push_back(uniform(-4.0f, 6.0f));
    for (int k = 0; k < cloud.coefficients() * 3; ++k)
      cloud.sh.push_back(k < 3 ? uniform(-1.5f, 1.5f) : uniform(-0.3f, 0.3f));
  }
  return cloud;
}

}  // namespace voyager::test
