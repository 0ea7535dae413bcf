// Lists of instances that change between frames.
#include <cmath>
#include <deque>
#include <random>
#include <thread>

#include "baked_scene.h"
#include "counting_allocator.h"
#include "on_backend.h"
#include "stage.h"

namespace set_instances_test {
namespace {

VoyInstance instance_of(VoyScene scene, const VoyInstancePose& pose = pose_of(0, 0, 0)) {
  VoyInstance instance = VOY_INSTANCE_INIT;
  instance.scene = scene;
  instance.pose = pose.pose;
  instance.scale = pose.scale;
  return instance;
}

using List = std::vector<VoyInstance>;

class SetInstances : public OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (!IsSkipped() && !HasFatalFailure()) stage = std::make_unique<Stage>(voy, GetParam());
  }
  VoyScene open_baked(int gaussians, bool streamed) {
    baked.emplace_back();
    baked.back().bytes = baked_bytes(gaussians);
    const VoyByteSource source = baked.back().source();
    const VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    if (streamed) desc.next = &streaming;
    desc.source = &source;
    VoyScene scene = nullptr;
    EXPECT_EQ(voy.OpenScene(stage->device, &desc, &scene), VOY_SUCCESS) << voy.message();
    return scene;
  }
  VoyResult set(VoyView view, const List& list) {
    return voy.SetViewInstances(view, static_cast<uint32_t>(list.size()), list.data());
  }
  VoyView view_of(const List& list) {
    std::vector<VoyScene> scenes;
    for (const VoyInstance& instance : list) scenes.push_back(instance.scene);
    const VoyView view = stage->view_of(scenes);
    EXPECT_EQ(set(view, list), VOY_SUCCESS) << voy.message();
    return view;
  }
  // Of a complete frame: streamed scenes wait.
  Picture draw(VoyView view, const VoyFrameEye& eye) {
    VoyFrameStreaming streaming = VOY_FRAME_STREAMING_INIT;
    streaming.waitResident = 1;
    VoyFrame frame = Host::frame(eye);
    frame.next = &streaming;
    EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
    return {stage->pixels, stage->depth};
  }
  std::vector<uint32_t> cut(VoyView view, uint32_t instance) {
    uint32_t count = 0;
    EXPECT_EQ(voy.GetViewCut(view, instance, 0, nullptr, &count), VOY_SUCCESS) << voy.message();
    std::vector<uint32_t> nodes(count);
    EXPECT_EQ(voy.GetViewCut(view, instance, count, nodes.data(), &count), VOY_SUCCESS);
    return nodes;
  }
  VoyFrameStats stats(VoyView view) {
    VoyFrameStats found = VOY_FRAME_STATS_INIT;
    EXPECT_EQ(voy.GetFrameStats(view, &found), VOY_SUCCESS) << voy.message();
    return found;
  }
  void expect_refused(VoyResult found, VoyResult expected, const char* part) {
    EXPECT_EQ(found, expected) << voy.message();
    EXPECT_NE(voy.message().find(part), std::string::npos) << voy.message();
  }

  std::deque<BytesHost> baked;  // outlive the device, whose threads read them
  std::unique_ptr<Stage> stage;
};

TEST_P(SetInstances, AFrameIsThatOfAViewMadeWithTheList) {
  const VoyScene flat = stage->open(ply_bytes(300)), tree = open_baked(1500, false),
                 streamed = open_baked(1500, true);
  const VoyScene scenes[] = {flat, tree, streamed};
  const VoyView view = stage->view_of({flat});
  std::mt19937 random(5);
  const auto below = [&](uint32_t count) { return random() % count; };
  List list;
  for (int step = 0; step < 14; ++step) {
    if (step % 3 != 2) {  // else the same scenes, elsewhere
      list.assign(below(5), {});
      for (VoyInstance& instance : list) instance = instance_of(scenes[below(3)]);
    }
    for (VoyInstance& instance : list) {
      const VoyInstancePose pose = pose_of(below(9) - 4.0, below(5) - 2.0, 0, below(360), 0.7);
      instance.pose = pose.pose, instance.scale = pose.scale;
      instance.opacity = below(2) == 0 ? 1 : static_cast<float>(below(5)) / 4;
      if (below(3) == 0) instance.clipMin[0] = -5, instance.clipMax[1] = 2;
    }
    ASSERT_EQ(set(view, list), VOY_SUCCESS) << voy.message();
    const VoyFrameEye eye = stage->eye(0.4 * step - 2);
    const Picture found = draw(view, eye);
    const VoyView fresh = view_of(list);
    EXPECT_TRUE(draw(fresh, eye) == found) << step;
    EXPECT_EQ(stats(view).cutSize, stats(fresh).cutSize) << step;
    for (uint32_t i = 0; i < list.size(); ++i) {
      if (list[i].scene == flat) continue;
      EXPECT_EQ(cut(view, i), cut(fresh, i)) << step;
    }
    EXPECT_EQ(voy.DestroyView(fresh), VOY_SUCCESS);
  }
  EXPECT_EQ(stats(view).frameIndex, 13u);
}

TEST_P(SetInstances, AnInstanceThatStaysKeepsItsCut) {
  const VoyScene tree = open_baked(1500, false), other = stage->open(ply_bytes(50));
  const VoyView view = stage->view_of({tree, other});
  const VoyFrameEye eye = stage->eye(1);
  draw(view, eye);
  EXPECT_GT(stats(view).nodesEntered, 0u);
  const std::vector<uint32_t> before = cut(view, 0);
  for (const List& list : {List{instance_of(other), instance_of(tree)}, List{instance_of(tree)}}) {
    ASSERT_EQ(set(view, list), VOY_SUCCESS) << voy.message();
    const auto last = static_cast<uint32_t>(list.size() - 1);
    uint32_t count = 0;
    expect_refused(voy.GetViewCut(view, last, 0, nullptr, &count), VOY_ERROR_INVALID_ARGUMENT,
                   "has changed the scenes since the last frame");
    draw(view, eye);
    EXPECT_EQ(stats(view).nodesEntered, 0u);
    EXPECT_EQ(cut(view, last), before);
  }
  // A second one of the scene is new.
  ASSERT_EQ(set(view, {instance_of(tree), instance_of(tree)}), VOY_SUCCESS);
  draw(view, eye);
  EXPECT_EQ(stats(view).nodesEntered, before.size());
  EXPECT_EQ(stats(view).cutSize, 2 * before.size());
}

TEST_P(SetInstances, NoneDrawTheBackground) {
  VoyViewDesc desc = stage->view_desc();
  desc.instanceCount = 0;
  desc.scenes = nullptr;
  VoyView view = nullptr;
  ASSERT_EQ(voy.CreateView(stage->device, &desc, &view), VOY_SUCCESS) << voy.message();
  const VoyFrameEye eye = stage->eye();
  VoyFrame frame = Host::frame(eye);
  frame.background[1] = 0.25f;
  const auto expect_background = [&] {
    ASSERT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
    for (size_t i = 0; i < stage->depth.size(); ++i) {
      const float* rgba = &stage->pixels[4 * i];
      ASSERT_TRUE(rgba[0] == 0 && rgba[1] == 0.25f && rgba[2] == 0 && rgba[3] == 0) << i;
      ASSERT_TRUE(std::isinf(stage->depth[i])) << i;
    }
    EXPECT_EQ(stats(view).splats, 0u);
    EXPECT_EQ(stats(view).cutSize, 0u);
  };
  expect_background();
  uint32_t count = 0;
  expect_refused(voy.GetViewCut(view, 0, 0, nullptr, &count), VOY_ERROR_INVALID_ARGUMENT,
                 "a view without instances");
  EXPECT_EQ(voy.GetViewOmissions(view, 0, nullptr, &count), VOY_SUCCESS) << voy.message();
  ASSERT_EQ(set(view, {instance_of(stage->scene)}), VOY_SUCCESS) << voy.message();
  ASSERT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
  EXPECT_GT(stats(view).splats, 0u);
  ASSERT_EQ(voy.SetViewInstances(view, 0, nullptr), VOY_SUCCESS) << voy.message();
  expect_background();
}

// Its tau may come to matter. Until it does, late frames leave it as it is. Where it never can, a
// budget is refused.
TEST_P(SetInstances, AViewWithoutATreeMayHaveATimeBudget) {
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = 1e-6;
  const VoyView view = stage->view_of({});
  EXPECT_EQ(voy.SetViewTimeBudget(view, &budget), VOY_SUCCESS) << voy.message();
  ASSERT_EQ(set(view, {instance_of(stage->scene)}), VOY_SUCCESS) << voy.message();
  for (int i = 0; i < 12; ++i) draw(view, stage->eye());
  EXPECT_EQ(stats(view).tau, stage->view_desc().tau);
  ASSERT_EQ(set(view, {instance_of(open_baked(1500, false))}), VOY_SUCCESS) << voy.message();
  draw(view, stage->eye());
  EXPECT_EQ(stats(view).timeBudgetState, VOY_TIME_BUDGET_STATE_LATE);
  EXPECT_EQ(stats(view).tau, stage->view_desc().tau);
  VoyViewDesc desc = stage->view_desc();
  desc.instanceCount = 0;
  desc.lod = VOY_LOD_ALL_LEAVES;
  VoyView leaves = nullptr;
  ASSERT_EQ(voy.CreateView(stage->device, &desc, &leaves), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.SetViewTimeBudget(leaves, &budget), VOY_ERROR_UNSUPPORTED);
}

TEST_P(SetInstances, OpacityOneChangesNoBitAndZeroDrawsNothing) {
  const VoyScene tree = open_baked(1500, false);
  const VoyFrameEye eye = stage->eye(-1);
  for (const VoyScene scene : {stage->scene, tree}) {
    const Picture expected = draw(stage->view_of({scene}), eye),
                  nothing = draw(stage->view_of({}), eye);
    VoyInstance instance = instance_of(scene);
    const VoyView view = view_of({instance});
    EXPECT_TRUE(draw(view, eye) == expected);
    instance.opacity = 0;
    ASSERT_EQ(set(view, {instance}), VOY_SUCCESS);
    EXPECT_TRUE(draw(view, eye) == nothing);
    instance.opacity = 0.5f;
    ASSERT_EQ(set(view, {instance}), VOY_SUCCESS);
    EXPECT_GT(largest_difference(draw(view, eye), expected), 0.05);
    // Beside another one, what is not drawn changes nothing.
    instance.opacity = 0;
    ASSERT_EQ(set(view, {instance, instance_of(scene)}), VOY_SUCCESS);
    EXPECT_TRUE(draw(view, eye) == expected);
  }
}

TEST_P(SetInstances, OpacitiesAgreeWithTheReference) {
  Stage judge(voy, VOY_BACKEND_REFERENCE);
  const VoyView view = stage->view_of({stage->scene}), judged = judge.view_of({judge.scene});
  for (const float opacity : {0.9f, 0.4f, 0.03f}) {
    VoyInstance instance = instance_of(stage->scene, pose_of(1, 0, 0, 20));
    instance.opacity = opacity;
    ASSERT_EQ(set(view, {instance}), VOY_SUCCESS);
    instance.scene = judge.scene;
    ASSERT_EQ(voy.SetViewInstances(judged, 1, &instance), VOY_SUCCESS) << voy.message();
    const Picture found = draw(view, stage->eye());
    const Picture expected = judge.draw(judged, judge.eye());
    EXPECT_GE(psnr(found, expected), 60) << opacity;
    EXPECT_LE(largest_difference(found, expected), 2.0 / 255) << opacity;
  }
}

// The .ply of the Gaussians that a box holds.
std::string ply_inside(const std::string& ply, int count, const VoyInstance& box) {
  const size_t body = ply.find("end_header\n") + 11;
  const size_t each = (ply.size() - body) / static_cast<size_t>(count);
  std::string kept;
  for (size_t at = body; at < ply.size(); at += each) {
    float mean[3];
    std::memcpy(mean, ply.data() + at, sizeof mean);
    bool inside = true;
    for (int i = 0; i < 3; ++i)
      inside = inside && double{mean[i]} >= box.clipMin[i] && double{mean[i]} <= box.clipMax[i];
    if (inside) kept += ply.substr(at, each);
  }
  std::string head = ply.substr(0, body);
  const std::string all = "vertex " + std::to_string(count);
  head.replace(head.find(all), all.size(), "vertex " + std::to_string(kept.size() / each));
  return head + kept;
}

TEST_P(SetInstances, AClippedSceneIsTheSceneMadeOfWhatIsInside) {
  const std::string ply = stage->whole();
  const size_t body = ply.find("end_header\n") + 11;
  float first[3];  // a Gaussian on the boundary
  std::memcpy(first, ply.data() + body, sizeof first);
  const VoyView view = stage->view_of({stage->scene});
  const VoyFrameEye eye = stage->eye(1);
  const VoyInstancePose pose = pose_of(0.5, -1, 0, 35, 1.1);
  VoyInstance boxes[4];
  for (VoyInstance& box : boxes) box = instance_of(stage->scene, pose);
  boxes[0].clipMin[0] = double{first[0]};
  boxes[1].clipMax[0] = double{first[0]}, boxes[1].clipMin[1] = -2, boxes[1].clipMax[2] = 3;
  for (int i = 0; i < 3; ++i) boxes[2].clipMin[i] = boxes[2].clipMax[i] = double{first[i]};
  boxes[3].clipMin[0] = std::nextafter(first[0], 100.0f);
  for (const VoyInstance& box : boxes) {
    ASSERT_EQ(set(view, {box}), VOY_SUCCESS) << voy.message();
    const VoyScene inside = stage->open(ply_inside(ply, Stage::kGaussians, box));
    VoySceneInfo info = VOY_SCENE_INFO_INIT;
    ASSERT_EQ(voy.GetSceneInfo(inside, &info), VOY_SUCCESS);
    const VoyView alone = view_of({instance_of(inside, pose)});
    EXPECT_TRUE(draw(view, eye) == draw(alone, eye)) << info.gaussianCount;
    EXPECT_EQ(stats(view).splats, stats(alone).splats) << info.gaussianCount;
    ASSERT_LT(info.gaussianCount, uint64_t{Stage::kGaussians});
  }
  // What is cut off is not in the way of what a box beside it keeps.
  List parts = {boxes[0], boxes[1]};
  parts[0].clipMin[0] = std::nextafter(first[0], 100.0f);
  parts[1].clipMin[1] = -1e300, parts[1].clipMax[2] = 1e300;
  ASSERT_EQ(set(view, parts), VOY_SUCCESS);
  EXPECT_LE(
      largest_difference(draw(view, eye), draw(view_of({instance_of(stage->scene, pose)}), eye)),
      1.0 / 255);
}

// Of nodes and of blended nodes, the centres that are drawn count: a tree's halves cover no more
// than the tree, and nothing outside is left.
TEST_P(SetInstances, AStreamedTreeIsClippedAsOneInMemory) {
  const VoyScene tree = open_baked(1500, false), streamed = open_baked(1500, true);
  const VoyFrameEye eye = stage->eye(2);
  VoyInstance instance = instance_of(tree);
  instance.clipMin[0] = -3, instance.clipMax[0] = 6;
  instance.opacity = 0.7f;
  const VoyView whole = view_of({instance});
  instance.scene = streamed;
  const VoyView other = view_of({instance});
  for (const double tau : {0.5, 6.0, 40.0}) {
    ASSERT_EQ(voy.SetViewTau(whole, tau), VOY_SUCCESS);
    ASSERT_EQ(voy.SetViewTau(other, tau), VOY_SUCCESS);
    EXPECT_TRUE(draw(whole, eye) == draw(other, eye)) << tau;
    EXPECT_LT(stats(whole).splats, stats(whole).cutSize) << tau;
  }
}

TEST_P(SetInstances, PosesOfAFrameStandInForThoseOfTheList) {
  const VoyInstancePose listed = pose_of(2, 0, 0, 30), framed = pose_of(-1, 1, 0, 100, 0.8);
  VoyInstance instance = instance_of(stage->scene, listed);
  instance.opacity = 0.6f;
  instance.clipMin[1] = -3;
  const VoyView view = view_of({instance});
  const VoyFrameEye eye = stage->eye();
  const Picture expected = draw(view, eye);
  const Picture moved = stage->draw(view, eye, {&framed, 1});
  EXPECT_FALSE(moved == expected);
  EXPECT_TRUE(stage->draw(view, eye, {&listed, 1}) == expected);
  EXPECT_TRUE(draw(view, eye) == expected) << "the frame's pose stayed";
  instance.pose = framed.pose, instance.scale = framed.scale;
  EXPECT_TRUE(draw(view_of({instance}), eye) == moved);
}

TEST_P(SetInstances, AViewWhoseSceneWasClosedDrawsAgain) {
  const VoyScene second = open_baked(1500, false), third = stage->open(ply_bytes(80));
  const VoyView view = stage->view_of({second, stage->scene, third, second});
  const VoyFrameEye eye = stage->eye();
  draw(view, eye);
  const Picture expected = draw(stage->view_of({stage->scene}), eye);
  ASSERT_EQ(voy.CloseScene(second), VOY_SUCCESS);
  const VoyFrame frame = Host::frame(eye);
  expect_refused(voy.RenderFrame(view, &frame), VOY_ERROR_SCENE_CLOSED,
                 "expected voySetViewInstances");
  expect_refused(set(view, {instance_of(stage->scene), instance_of(second)}),
                 VOY_ERROR_INVALID_HANDLE, "instances[1].scene: scene: found");
  EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_ERROR_SCENE_CLOSED) << "a refused list changed it";
  ASSERT_EQ(voy.CloseScene(third), VOY_SUCCESS);
  ASSERT_EQ(set(view, {instance_of(stage->scene)}), VOY_SUCCESS) << voy.message();
  EXPECT_TRUE(draw(view, eye) == expected);
  EXPECT_EQ(stats(view).frameIndex, 1u);
  // Of scenes that it no longer draws, it does not notice.
  const VoyScene gone = stage->open(ply_bytes(20));
  ASSERT_EQ(set(view, {instance_of(gone), instance_of(stage->scene)}), VOY_SUCCESS);
  ASSERT_EQ(set(view, {instance_of(stage->scene)}), VOY_SUCCESS);
  ASSERT_EQ(voy.CloseScene(gone), VOY_SUCCESS);
  EXPECT_TRUE(draw(view, eye) == expected);
  ASSERT_EQ(voy.CloseScene(stage->scene), VOY_SUCCESS);
  EXPECT_EQ(voy.SetViewTau(view, 2), VOY_ERROR_SCENE_CLOSED);
  ASSERT_EQ(voy.SetViewInstances(view, 0, nullptr), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.RenderFrame(view, &frame), VOY_SUCCESS) << voy.message();
}

// Each of the allocations of a list's change may be the one that fails.
TEST_P(SetInstances, WhatFailsChangesNothing) {
  if (GetParam() == VOY_BACKEND_CUDA) GTEST_SKIP() << "state is in the GPU's memory";
  CountingAllocator memory;
  const VoyAllocator allocator = memory.desc();
  VoyDeviceDesc desc = device_for(GetParam());
  desc.allocator = &allocator;
  baked.emplace_back();
  baked.back().bytes = baked_bytes(1500);
  {
    Host host(voy, desc);
    const VoyByteSource source = baked.back().source();
    VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
    scene_desc.source = &source;
    VoyScene tree = nullptr;
    ASSERT_EQ(voy.OpenScene(host.device, &scene_desc, &tree), VOY_SUCCESS) << voy.message();
    ASSERT_EQ(host.render(), VOY_SUCCESS);
    const std::vector<float> expected = host.pixels;
    const List list = {instance_of(tree), instance_of(host.scene)};
    int failures = 0;
    for (;; ++failures) {
      ASSERT_LT(failures, 1000) << "it never completes";
      memory.failing = memory.allocations + failures;
      const VoyResult result = set(host.view, list);
      memory.failing = -1;
      if (result == VOY_SUCCESS) break;
      EXPECT_EQ(result, VOY_ERROR_OUT_OF_HOST_MEMORY) << voy.message();
      ASSERT_EQ(host.render(), VOY_SUCCESS) << voy.message();
      EXPECT_EQ(host.pixels, expected) << failures;
    }
    EXPECT_GT(failures, 0);
    // What is removed gives its memory back, however often it comes.
    int64_t without = 0;
    for (int round = 0; round < 4; ++round) {
      ASSERT_EQ(host.render(), VOY_SUCCESS) << voy.message();
      const int64_t with = memory.bytes_out;
      ASSERT_EQ(set(host.view, {instance_of(host.scene)}), VOY_SUCCESS);
      if (round == 0) without = memory.bytes_out;
      EXPECT_EQ(memory.bytes_out, without) << round;
      EXPECT_LT(without, with);
      ASSERT_EQ(set(host.view, list), VOY_SUCCESS) << voy.message();
    }
  }
  EXPECT_EQ(memory.bytes_out, 0);
}

// As every call on a view: one at a time.
TEST_P(SetInstances, ListsAndFramesOfTwoThreads) {
  const VoyView view = stage->view_of({stage->scene});
  std::atomic<bool> done{false};
  std::thread renderer([&] {
    const VoyFrameEye eye = stage->eye();
    const VoyFrame frame = Host::frame(eye);
    for (int i = 0; i < 6; ++i) {
      const VoyResult result = voy.RenderFrame(view, &frame);
      EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_BUSY) << voy.message();
    }
    done = true;
  });
  const List one = {instance_of(stage->scene)}, two = {one[0], one[0]};
  for (int i = 0; !done; ++i) {
    const VoyResult result = set(view, i % 2 == 0 ? two : one);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_BUSY) << voy.message();
    std::this_thread::yield();
  }
  renderer.join();
}

INSTANTIATE_TEST_SUITE_P(On, SetInstances, ::testing::ValuesIn(kEachBackend), backend_name);

}  // namespace
}  // namespace set_instances_test
