// Several scenes in one view, as a host draws them.
#include <algorithm>
#include <array>

#include "stage.h"
#include "tests/support/needs.h"

namespace instances_test {
namespace {

constexpr VoyBackend kDrawing[] = {VOY_BACKEND_CPU, VOY_BACKEND_REFERENCE, VOY_BACKEND_CUDA};

using Quat = std::array<double, 4>;  // x, y, z, w

Quat product(const double* a, const double* b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

std::array<double, 3> turned(const double* q, const double* v) {
  const double plain[4] = {v[0], v[1], v[2], 0}, inverse[4] = {-q[0], -q[1], -q[2], q[3]};
  const Quat half = product(q, plain), whole = product(half.data(), inverse);
  return {whole[0], whole[1], whole[2]};
}

// The eye that sees a posed instance as `eye` sees the scene.
VoyFrameEye follow(VoyFrameEye eye, const VoyInstancePose& instance) {
  const auto from = turned(instance.pose.orientation, eye.pose.position);
  for (size_t i = 0; i < 3; ++i)
    eye.pose.position[i] = instance.pose.position[i] + instance.scale * from[i];
  const Quat q = product(instance.pose.orientation, eye.pose.orientation);
  std::copy(q.begin(), q.end(), eye.pose.orientation);
  return eye;
}

class Instances : public ::testing::TestWithParam<VoyBackend> {
 protected:
  void SetUp() override {
    if (voy.QueryBackend(GetParam()) != VOY_SUCCESS) VOYAGER_SKIP_WITHOUT(CUDA, voy.message());
    stage = std::make_unique<Stage>(voy, GetParam());
  }

  Library voy;
  std::unique_ptr<Stage> stage;
};

TEST_P(Instances, TwoHalvesOfASceneAreTheWhole) {
  const VoyView whole = stage->view_of({stage->scene});
  const VoyView halves =
      stage->view_of({stage->open(stage->part(700, false)), stage->open(stage->part(700, true))});
  for (const double x : {-6.0, 0.0, 9.0}) {
    const VoyFrameEye eye = stage->eye(x, 0.1 * x);
    const Picture expected = stage->draw(whole, eye), found = stage->draw(halves, eye);
    EXPECT_LE(largest_difference(expected, found), 1.0 / 255) << x;
    EXPECT_EQ(expected.depth, found.depth) << x;
    if (GetParam() != VOY_BACKEND_CUDA) {
      EXPECT_TRUE(expected == found) << x;
    }
  }
}

TEST_P(Instances, ATurnedAndScaledInstanceIsTheInverseCameraMove) {
  const VoyView view = stage->view_of({stage->scene});
  for (const double x : {-6.0, 4.0}) {
    const VoyFrameEye eye = stage->eye(x, 0.2);
    const Picture expected = stage->draw(view, eye);
    for (const VoyInstancePose& pose :
         {pose_of(3, -2, 8), pose_of(0, 0, 0, 140), pose_of(0, 0, 0, 0, 0.02),
          pose_of(-500, 1000, 70, 250, 6.5)}) {
      const Picture found = stage->draw(view, follow(eye, pose), {&pose, 1}, 0.2 * pose.scale);
      EXPECT_GE(psnr(expected, found), 60) << pose.scale;
      size_t apart = 0;
      for (size_t i = 0; i < found.depth.size(); ++i) {
        const double depth = double{expected.depth[i]} * pose.scale;
        const double other = double{found.depth[i]};
        apart += !(other == depth || std::fabs(other - depth) <= 1e-4 * depth);
      }
      EXPECT_LE(apart, found.depth.size() / 1000) << pose.scale;
      EXPECT_LT(psnr(expected, stage->draw(view, eye, {&pose, 1})), 40)
          << "the pose changes nothing";
    }
  }
}

TEST_P(Instances, TheIdentityIsNoPoseAtAll) {
  const VoyView one = stage->view_of({stage->scene}),
                two = stage->view_of({stage->scene, stage->open(ply_bytes(50))});
  const VoyInstancePose poses[2] = {pose_of(0, 0, 0), pose_of(0, 0, 0)};
  const VoyFrameEye eye = stage->eye(2, 0.1);
  EXPECT_TRUE(stage->draw(one, eye) == stage->draw(one, eye, {poses, 1}));
  EXPECT_TRUE(stage->draw(two, eye) == stage->draw(two, eye, poses));
}

// Where every depth ties: the order is that of the instances, as in a scene it is that of the
// Gaussians.
TEST_P(Instances, ASceneTwiceInOnePlaceIsAsOneWithItsGaussiansTwice) {
  const std::string ply = stage->part(400, false);
  const size_t body = ply.find("end_header\n") + 11;
  std::string twice = ply + ply.substr(body);
  twice.replace(twice.find("vertex 400"), 10, "vertex 800");
  const VoyScene scene = stage->open(ply);
  const VoyFrameEye eye = stage->eye(1);
  const Picture expected = stage->draw(stage->view_of({stage->open(twice)}), eye);
  EXPECT_TRUE(expected == stage->draw(stage->view_of({scene, scene}), eye));
  EXPECT_FALSE(expected == stage->draw(stage->view_of({scene}), eye));
}

// One view of two instances of a scene, apart; what is to be seen at either place is what a
// view of one there sees.
TEST_P(Instances, OneSceneStandsInTwoPlaces) {
  const VoyView both = stage->view_of({stage->scene, stage->scene}),
                one = stage->view_of({stage->scene});
  const VoyInstancePose poses[2] = {pose_of(0, 0, 0), pose_of(1000, 0, 0, 30, 2)};
  const VoyFrameEye eye = stage->eye(0);
  EXPECT_GE(psnr(stage->draw(both, eye, poses), stage->draw(one, eye)), 60);
  const VoyFrameEye there = follow(eye, poses[1]);
  EXPECT_GE(psnr(stage->draw(both, there, poses), stage->draw(one, there, {poses + 1, 1})), 60);
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  ASSERT_EQ(voy.GetFrameStats(both, &stats), VOY_SUCCESS);
  EXPECT_EQ(stats.cutSize, 2u * Stage::kGaussians);
}

TEST_P(Instances, AsManyAsTheCapabilitiesSay) {
  VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
  ASSERT_EQ(voy.GetCapabilities(stage->device, &capabilities), VOY_SUCCESS);
  ASSERT_GT(capabilities.maxInstances, 1u);
  const VoyScene small = stage->open(ply_bytes(20));
  std::vector<VoyScene> scenes(capabilities.maxInstances, small);
  std::vector<VoyInstancePose> poses;
  for (uint32_t i = 0; i < capabilities.maxInstances; ++i) poses.push_back(pose_of(0, i, 0));
  stage->draw(stage->view_of(scenes), stage->eye(), poses);
  scenes.push_back(small);
  VoyViewDesc desc = stage->view_desc();
  desc.instanceCount = static_cast<uint32_t>(scenes.size());
  desc.scenes = scenes.data();
  VoyView view = nullptr;
  EXPECT_EQ(voy.CreateView(stage->device, &desc, &view), VOY_ERROR_UNSUPPORTED);
  EXPECT_NE(voy.message().find("desc.instanceCount: found 65, this version draws up to 64"),
            std::string::npos)
      << voy.message();
}

TEST_P(Instances, WhatIsWrongIsNamedByItsIndex) {
  const VoyView view = stage->view_of({stage->scene, stage->scene});
  const VoyFrameEye eye = stage->eye();
  const Picture before = stage->draw(view, eye);
  VoyInstancePose poses[2] = {pose_of(0, 0, 0), pose_of(0, 0, 0)};
  VoyFrame frame = Host::frame(eye);
  frame.instances = poses;
  frame.instanceCount = 2;
  const auto expect = [&](VoyResult expected, const char* part) {
    EXPECT_EQ(voy.RenderFrame(view, &frame), expected) << voy.message();
    EXPECT_NE(voy.message().find(part), std::string::npos) << voy.message();
    EXPECT_EQ(stage->pixels, before.pixels);
    poses[1] = pose_of(0, 0, 0);
  };
  poses[1].scale = 0;
  expect(VOY_ERROR_INVALID_ARGUMENT, "frame.instances[1].scale: found 0, expected 1e-9 to 1e9");
  poses[1].pose.position[2] = kNan;
  expect(VOY_ERROR_INVALID_ARGUMENT, "frame.instances[1].pose.position: found nan");
  poses[1].pose.orientation[2] = kInf;
  expect(VOY_ERROR_INVALID_ARGUMENT, "frame.instances[1].pose.orientation: found inf");
  poses[1].type = VOY_STRUCTURE_TYPE_FRAME;
  expect(VOY_ERROR_INVALID_STRUCTURE, "frame.instances[1].type");
  poses[1] = pose_of(1e17, 0, 0, 0, 1e-5);
  expect(VOY_ERROR_INVALID_ARGUMENT, "instance 1");
  frame.instanceCount = 1;
  expect(VOY_ERROR_INVALID_ARGUMENT, "frame.instanceCount: found 1, expected 2");
  frame.instances = nullptr;
  expect(VOY_ERROR_INVALID_ARGUMENT, "frame.instanceCount: found 1, expected 0");
  uint32_t count = 0;
  EXPECT_EQ(voy.GetViewCut(view, 1, 0, nullptr, &count), VOY_ERROR_UNSUPPORTED);
  EXPECT_EQ(voy.GetViewCut(view, 2, 0, nullptr, &count), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(voy.message().find("instance: found 2, expected 0 to 1"), std::string::npos);
}

TEST_P(Instances, AreOfTheViewsDeviceAndLiveAsLongAsTheirScenes) {
  Stage other(voy, GetParam());
  std::vector<VoyScene> scenes = {stage->scene, other.scene};
  VoyViewDesc desc = stage->view_desc();
  desc.instanceCount = 2;
  desc.scenes = scenes.data();
  VoyView view = nullptr;
  EXPECT_EQ(voy.CreateView(stage->device, &desc, &view), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(voy.message().find("desc.scenes[1]: found a scene of another device"),
            std::string::npos)
      << voy.message();
  scenes[1] = nullptr;
  EXPECT_EQ(voy.CreateView(stage->device, &desc, &view), VOY_ERROR_INVALID_HANDLE);
  EXPECT_NE(voy.message().find("desc.scenes[1]: scene: found NULL"), std::string::npos)
      << voy.message();

  const VoyScene second = stage->open(ply_bytes(100));
  const VoyView alone = stage->view_of({stage->scene}),
                both = stage->view_of({stage->scene, second});
  const VoyFrameEye eye = stage->eye();
  const Picture expected = stage->draw(alone, eye);
  stage->draw(both, eye);
  ASSERT_EQ(voy.CloseScene(second), VOY_SUCCESS);
  const VoyFrame frame = Host::frame(eye);
  EXPECT_EQ(voy.RenderFrame(both, &frame), VOY_ERROR_SCENE_CLOSED);
  EXPECT_EQ(voy.SetViewTau(both, 1), VOY_ERROR_SCENE_CLOSED);
  EXPECT_TRUE(expected == stage->draw(alone, eye)) << "the other scene's views are as they were";
  ASSERT_EQ(voy.CloseScene(stage->scene), VOY_SUCCESS);
  EXPECT_EQ(voy.RenderFrame(both, &frame), VOY_ERROR_SCENE_CLOSED);
  EXPECT_EQ(voy.DestroyView(both), VOY_SUCCESS);
}

// memoryBudget is the device's: what one instance's scene takes is gone for the next. The view
// of those that fit draws on.
TEST_P(Instances, ScenesShareOneBudget) {
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  ASSERT_EQ(voy.GetSceneInfo(stage->scene, &info), VOY_SUCCESS);
  VoyDeviceDesc desc = device_for(GetParam());
  desc.hostMemoryBudget = 7 * info.residentBytes / 2;
  Host small(voy, desc, Stage::kGaussians);
  const VoyByteSource source = stage->bytes.source();
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.source = &source;
  std::vector<VoyScene> scenes = {small.scene};
  VoyScene more = nullptr;
  while (voy.OpenScene(small.device, &scene_desc, &more) == VOY_SUCCESS) {
    scenes.push_back(more);
    ASSERT_LE(scenes.size(), 3u);
  }
  EXPECT_NE(voy.message().find("MB"), std::string::npos) << voy.message();
  VoyViewDesc view_desc = small.view_desc();
  view_desc.instanceCount = static_cast<uint32_t>(scenes.size());
  view_desc.scenes = scenes.data();
  VoyView view = nullptr;
  ASSERT_EQ(voy.CreateView(small.device, &view_desc, &view), VOY_SUCCESS) << voy.message();
  const VoyFrameEye eye = small.eye();
  const VoyFrame frame = Host::frame(eye);
  EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
}

std::string name_of(const ::testing::TestParamInfo<VoyBackend>& backend) {
  switch (backend.param) {
    case VOY_BACKEND_CPU:
      return "Cpu";
    case VOY_BACKEND_REFERENCE:
      return "Reference";
    default:
      return "Cuda";
  }
}

INSTANTIATE_TEST_SUITE_P(On, Instances, ::testing::ValuesIn(kDrawing), name_of);

}  // namespace
}  // namespace instances_test
