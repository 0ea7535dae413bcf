// CUDA's frames of real scenes against the float64 reference's and the CPU's.
#include <filesystem>

#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/camera_files.h"
#include "tests/support/real_scenes.h"

namespace voyager::test {
namespace splat_real_test {
namespace {

#define VOYAGER_NEEDS_FILE(path) \
  if (!std::filesystem::exists(path)) VOYAGER_SKIP_WITHOUT(SCENES, (path) + " is not here")

class SplatReal : public SplatTest {
 protected:
  // As a walk: each view carries its cut from frame to frame.
  void expect_near(const std::string& name, Backend& other,
                   const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc,
                   const std::vector<FrameInput>& path) {
    Agreement agreement(name + ", CUDA against " + other.device_name());
    const auto own = view(scene, desc), judge = view(other, scene, desc);
    for (const FrameInput& input : path) agreement.add(render(*own, input), render(*judge, input));
    agreement.expect();
  }
  void expect_near(const std::string& name, const std::shared_ptr<const Scene>& scene,
                   const PipelineDesc& desc, const std::vector<FrameInput>& path) {
    expect_near(name, *reference, scene, desc, path);
    expect_near(name, *cpu, scene, desc, path);
  }
};

std::vector<FrameInput> path_of(const std::string& file, size_t count, uint32_t width,
                                uint32_t height, double tau) {
  std::vector<FrameInput> path;
  for (const Camera& camera : spread(read_cameras(file), count))
    path.push_back(frame_input(resized(camera, width, height), tau));
  return path;
}

TEST_F(SplatReal, TheDistrict) {
  VOYAGER_NEEDS_SCENES(folder);
  const std::string district = folder + "/district";
  for (const char* part :
       {".spz", ".stills.cameras.json", ".flight.cameras.json", ".headset.cameras.json"})
    VOYAGER_NEEDS_FILE(district + part);
  const auto scene = baked_scene(import_file(district + ".spz"));
  const std::string stills = district + ".stills.cameras.json";
  for (const double tau : {0.0, 3.0, 15.0})
    expect_near("stills, tau " + std::to_string(tau), scene, {}, path_of(stills, 4, 480, 270, tau));
  expect_near("stills, all leaves", scene, {.lod = Lod::all_leaves},
              path_of(stills, 4, 480, 270, 3));
  expect_near("stills, whole size", *cpu, scene, {}, path_of(stills, 4, 1920, 1080, 3));
  expect_near("flight", scene, {}, path_of(district + ".flight.cameras.json", 20, 480, 270, 3));
  expect_near("headset", scene, {}, path_of(district + ".headset.cameras.json", 20, 258, 276, 3));
}

// From above at an angle, the middle of the scene across most of the image.
std::vector<FrameInput> overview(const Scene& scene) {
  const auto [middle, reach] = middle_of(scene);
  std::vector<FrameInput> frames;
  for (const double tau : {0.0, 3.0, 15.0})
    for (const double side : {-0.5, 0.4})
      frames.push_back(
          frame_input(look(middle + reach * Vec3d{side, -0.6, -0.7}, middle, 480, 320), tau));
  return frames;
}

class SplatObject : public SplatReal {
 protected:
  void expect_near_baked_and_flat(const std::string& path) {
    const GaussianCloud cloud = import_file(path);
    const auto baked = baked_scene(cloud);
    const std::string name = std::filesystem::path(path).filename();
    const std::vector<FrameInput> frames = overview(*baked);
    expect_near(name, baked, {}, frames);
    expect_near(name + ", flat", flat_scene(cloud), {}, {frames[0], frames[1]});
  }
};

TEST_F(SplatObject, ABlockOfTheCity) {
  VOYAGER_NEEDS_SCENES(folder);
  std::string path = folder + "/formats/block.ply";
  if (!std::filesystem::exists(path)) path = folder + "/formats/block.spz";
  VOYAGER_NEEDS_FILE(path);
  expect_near_baked_and_flat(path);
}

TEST_F(SplatObject, PlaybotWithShDegreeTwo) {
  VOYAGER_NEEDS_SCENES(folder);
  const std::string path = folder + "/formats/playbot_lod3.ply";
  VOYAGER_NEEDS_FILE(path);
  expect_near_baked_and_flat(path);
}

}  // namespace
}  // namespace splat_real_test
}  // namespace voyager::test
