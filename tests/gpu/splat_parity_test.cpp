// CUDA's frames against the float64 reference's and the CPU's, on made-up scenes.
#include "runtime/scene/append.h"
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/camera_files.h"
#include "tools/synth/city.h"

namespace voyager::test {
namespace splat_parity_test {
namespace {

class SplatParity : public SplatTest {
 protected:
  void add(const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc,
           const FrameInput& input) {
    const Frame found = draw(scene, desc, input);
    against_reference.add(found, draw(*reference, scene, desc, input));
    against_cpu.add(found, draw(*cpu, scene, desc, input));
  }
  void expect_near() const {
    against_reference.expect();
    against_cpu.expect();
  }

  Agreement against_reference{"CUDA against the reference"}, against_cpu{"CUDA against the CPU"};
};

TEST_F(SplatParity, RandomCloudsOfEveryShDegree) {
  for (int degree = 0; degree <= 3; ++degree) {
    const GaussianCloud cloud = random_cloud(5000, 20 + static_cast<uint32_t>(degree), degree);
    const std::shared_ptr<const Scene> flat = flat_scene(cloud);
    const auto baked = baked_scene(cloud);
    for (const FrameInput& input : varied_frames()) {
      add(baked, {}, input);
      add(baked, {.lod = Lod::all_leaves}, input);
      add(flat, {}, input);
    }
  }
  expect_near();
}

// What detail is chosen by is the host's; what draws it is not.
TEST_F(SplatParity, BaselinesOfDetail) {
  const auto scene = baked_scene(random_cloud(20000, 33, 1));
  for (const Lod lod : {Lod::blocks, Lod::levels})
    for (const Search search : {Search::exhaustive, Search::streaming, Search::temporal})
      for (const FrameInput& input : varied_frames())
        add(scene, {.lod = lod, .search = search}, input);
  expect_near();
}

TEST_F(SplatParity, CompactStorage) {
  const auto scene = baked_scene(random_cloud(20000, 31, 3), Quality::compact);
  for (const FrameInput& input : varied_frames()) add(scene, {}, input);
  expect_near();
}

// Above kMaxHalfCoefficient the device keeps binary32 (cuda/scene/gaussian_view.h).
TEST_F(SplatParity, CoefficientsTooLargeForBinary16) {
  for (int degree = 0; degree <= 3; ++degree) {
    GaussianCloud cloud = random_cloud(3000, 40 + static_cast<uint32_t>(degree), degree);
    for (size_t i = 0; i < cloud.sh.size(); i += 97) cloud.sh[i] *= 40;
    const std::shared_ptr<const Scene> flat = flat_scene(cloud);
    const auto baked = baked_scene(cloud);
    for (const FrameInput& input : varied_frames()) {
      add(baked, {}, input);
      add(flat, {}, input);
    }
  }
  expect_near();
}

TEST_F(SplatParity, ASyntheticCityFromTheStreetAndFromTheAir) {
  const synth::CityDesc desc{150'000, 1, 3};
  GaussianCloud cloud;
  cloud.sh_degree = desc.sh_degree;
  synth::generate_city(
      desc, [&](const GaussianCloud& batch) { append(cloud, GaussianCloud(batch), "a batch"); });
  const auto scene = baked_scene(cloud);
  const auto cameras = cameras_of(nlohmann::json::parse(synth::city_cameras_json(desc)));
  for (const Camera& camera : spread(cameras, 6)) {
    for (const double tau : {0.0, 3.0, 15.0})
      add(scene, {}, frame_input(resized(camera, 320, 180), tau));
    add(scene, {.lod = Lod::all_leaves}, frame_input(resized(camera, 320, 180)));
  }
  expect_near();
}

TEST_F(SplatParity, OneTreeForWhichEverySearchDrawsTheSame) {
  const auto scene = baked_scene(random_cloud(20000, 32, 1));
  constexpr Search kSearches[] = {Search::exhaustive,     Search::streaming, Search::temporal,
                                  Search::temporal_visit, Search::sweep,     Search::fastest};
  std::vector<std::unique_ptr<View>> views;
  for (const Search search : kSearches) views.push_back(view(scene, {.search = search}));
  for (const FrameInput& input : varied_frames()) {
    const Frame first = render(*views[0], input);
    for (auto& other : std::span(views).subspan(1)) {
      const Frame found = render(*other, input);
      expect_same_bits(first, found);
      EXPECT_TRUE(first.cut == found.cut);
    }
  }
}

}  // namespace
}  // namespace splat_parity_test
}  // namespace voyager::test
