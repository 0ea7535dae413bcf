// NULL, wrong structures and wrong handles: an error with a message, no crash.
#include "hostile.h"

namespace handles_test {
namespace {

TEST_F(Hostile, NullEverywhere) {
  VoyDevice device = nullptr;
  VoyScene scene = nullptr;
  VoyView view = nullptr;
  VoyTarget target = nullptr;
  uint32_t count = 0;
  VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
  const VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  expect_invalid(voy.CreateDevice(nullptr, &device), "VoyDeviceDesc");
  expect_invalid(voy.CreateDevice(&desc, nullptr), "device");
  expect_invalid(voy.OpenScene(host.device, nullptr, &scene), "VoySceneDesc");
  expect_invalid(voy.CreateView(host.device, nullptr, &view), "VoyViewDesc");
  expect_invalid(voy.CreateTarget(host.device, nullptr, &target), "VoyTargetDesc");
  expect_invalid(voy.RenderFrame(host.view, nullptr), "VoyFrame");
  expect_invalid(voy.GetCapabilities(host.device, nullptr), "VoyCapabilities");
  expect_invalid(voy.GetSceneInfo(host.scene, nullptr), "VoySceneInfo");
  expect_invalid(voy.GetSceneNotes(host.scene, 4, nullptr, &count), "notes");
  expect_invalid(voy.GetSceneNotes(host.scene, 0, nullptr, nullptr), "count");
  expect_invalid(voy.GetViewCut(host.view, 0, 0, nullptr, nullptr), "count");
  expect_invalid(voy.GetFrameStats(host.view, nullptr), "VoyFrameStats");
  expect_invalid(voy.FrustumFromAngles(-1, 1, 1, -1, nullptr), "frustum");
  expect_invalid(voy.FrustumFromIntrinsics(1, 1, 1, 1, 1, 1, nullptr), "frustum");
  for (const VoyResult result :
       {voy.GetCapabilities(nullptr, &capabilities), voy.GetSceneInfo(nullptr, nullptr),
        voy.RenderFrame(nullptr, nullptr), voy.SetViewTau(nullptr, 1),
        voy.OpenScene(nullptr, nullptr, nullptr), voy.CreateView(nullptr, nullptr, nullptr)})
    expect_refused(result, VOY_ERROR_INVALID_HANDLE, "found NULL");
  EXPECT_EQ(voy.DestroyDevice(nullptr), VOY_SUCCESS);
  EXPECT_EQ(voy.CloseScene(nullptr), VOY_SUCCESS);
  EXPECT_EQ(voy.DestroyView(nullptr), VOY_SUCCESS);
  EXPECT_EQ(voy.DestroyTarget(nullptr), VOY_SUCCESS);
}

TEST_F(Hostile, WrongStructureTypesAndUnknownChains) {
  VoyDevice device = nullptr;
  for (const int type : {0, 2, -1, 14, INT32_MAX, INT32_MIN}) {
    VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
    desc.type = bad_enum<VoyStructureType>(type);
    expect_refused(voy.CreateDevice(&desc, &device), VOY_ERROR_INVALID_STRUCTURE, "expected 1");
  }
  VoyDeviceDesc chained = VOY_DEVICE_DESC_INIT;
  chained.next = &chained;
  expect_refused(voy.CreateDevice(&chained, &device), VOY_ERROR_INVALID_STRUCTURE, "next");
  EXPECT_EQ(device, nullptr);

  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  info.type = VOY_STRUCTURE_TYPE_FRAME;
  EXPECT_EQ(voy.GetSceneInfo(host.scene, &info), VOY_ERROR_INVALID_STRUCTURE);
  info.type = VOY_STRUCTURE_TYPE_SCENE_INFO;
  info.next = &info;
  EXPECT_EQ(voy.GetSceneInfo(host.scene, &info), VOY_ERROR_INVALID_STRUCTURE);
  VoyCapabilities capabilities = {};
  EXPECT_EQ(voy.GetCapabilities(host.device, &capabilities), VOY_ERROR_INVALID_STRUCTURE);
  VoyFrameStats stats = {};
  EXPECT_EQ(voy.GetFrameStats(host.view, &stats), VOY_ERROR_INVALID_STRUCTURE);
  VoyViewDesc view = host.view_desc();
  view.next = &view;
  EXPECT_EQ(create_view(view), VOY_ERROR_INVALID_STRUCTURE);
  VoyTargetDesc target = host.target_desc();
  target.type = VOY_STRUCTURE_TYPE_VIEW_DESC;
  EXPECT_EQ(create_target(target), VOY_ERROR_INVALID_STRUCTURE);
  const VoyFrameEye eye = host.eye();
  VoyFrame frame = Host::frame(eye);
  frame.next = &eye;
  EXPECT_EQ(voy.RenderFrame(host.view, &frame), VOY_ERROR_INVALID_STRUCTURE);
  VoyAllocator allocator = {};
  VoyDeviceDesc with_allocator = VOY_DEVICE_DESC_INIT;
  with_allocator.allocator = &allocator;
  EXPECT_EQ(create_device(with_allocator), VOY_ERROR_INVALID_STRUCTURE);
  allocator.type = VOY_STRUCTURE_TYPE_ALLOCATOR;
  EXPECT_EQ(create_device(with_allocator), VOY_ERROR_INVALID_ARGUMENT);
}

TEST_F(Hostile, ElementsOfArraysAreStructuresToo) {
  VoyFrameEye eye = host.eye();
  VoyInstancePose instance = VOY_INSTANCE_POSE_INIT;
  VoyFrame frame = Host::frame(eye);
  frame.instances = &instance;
  frame.instanceCount = 1;
  const auto expect_wrong = [&](const char* part) {
    expect_refused(voy.RenderFrame(host.view, &frame), VOY_ERROR_INVALID_STRUCTURE, part);
  };
  EXPECT_EQ(voy.RenderFrame(host.view, &frame), VOY_SUCCESS) << voy.message();
  eye.next = &eye;
  expect_wrong("frame.eyes[0].next");
  eye = {};
  expect_wrong("frame.eyes[0].type: found 0, expected 12");
  eye = host.eye();
  instance.next = &instance;
  expect_wrong("frame.instances[0].next");
  instance = {};
  expect_wrong("frame.instances[0].type: found 0, expected 13");
}

TEST_F(Hostile, GarbageStaleAndWrongKindHandlesAreToldApart) {
  int something = 0;
  for (void* garbage : {static_cast<void*>(&something), reinterpret_cast<void*>(1),
                        reinterpret_cast<void*>(UINTPTR_MAX), reinterpret_cast<void*>(0x5),
                        reinterpret_cast<void*>(0x0000000100ffff05)})
    expect_refused(voy.CloseScene(static_cast<VoyScene>(garbage)), VOY_ERROR_INVALID_HANDLE,
                   "no handle of this library");
  const auto as_scene = static_cast<VoyScene>(static_cast<void*>(host.view));
  expect_refused(voy.CloseScene(as_scene), VOY_ERROR_INVALID_HANDLE, "found a view handle");
  const auto as_view = static_cast<VoyView>(static_cast<void*>(host.target));
  EXPECT_EQ(voy.SetViewTau(as_view, 1), VOY_ERROR_INVALID_HANDLE);
  // Every single-bit change of a handle is another handle or none.
  for (int bit = 0; bit < 64; ++bit) {
    const auto changed = reinterpret_cast<uintptr_t>(host.view) ^ (uintptr_t{1} << bit);
    EXPECT_EQ(voy.SetViewTau(reinterpret_cast<VoyView>(changed), 1), VOY_ERROR_INVALID_HANDLE);
  }
  VoyViewDesc desc = host.view_desc();
  VoyView view = nullptr, again = nullptr;
  ASSERT_EQ(voy.CreateView(host.device, &desc, &view), VOY_SUCCESS);
  ASSERT_EQ(voy.DestroyView(view), VOY_SUCCESS);
  expect_refused(voy.SetViewTau(view, 1), VOY_ERROR_INVALID_HANDLE, "destroyed");
  EXPECT_EQ(voy.DestroyView(view), VOY_ERROR_INVALID_HANDLE);
  ASSERT_EQ(voy.CreateView(host.device, &desc, &again), VOY_SUCCESS);
  EXPECT_NE(view, again);
  EXPECT_EQ(voy.SetViewTau(view, 1), VOY_ERROR_INVALID_HANDLE);
  EXPECT_EQ(voy.DestroyView(again), VOY_SUCCESS);
}

TEST_F(Hostile, ChildrenDoNotOutliveTheirParents) {
  Host other(voy);
  ASSERT_EQ(other.render(), VOY_SUCCESS);
  ASSERT_EQ(voy.CloseScene(other.scene), VOY_SUCCESS);
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  expect_refused(other.render(), VOY_ERROR_SCENE_CLOSED, "scene was closed");
  EXPECT_EQ(voy.GetFrameStats(other.view, &stats), VOY_ERROR_SCENE_CLOSED);
  EXPECT_EQ(voy.SetViewTau(other.view, 1), VOY_ERROR_SCENE_CLOSED);
  expect_refused(voy.CloseScene(other.scene), VOY_ERROR_INVALID_HANDLE, "a scene that was closed");
  const VoyViewDesc desc = other.view_desc();
  VoyView view = nullptr;
  EXPECT_EQ(voy.CreateView(other.device, &desc, &view), VOY_ERROR_INVALID_HANDLE);
  EXPECT_EQ(voy.DestroyView(other.view), VOY_SUCCESS);

  ASSERT_EQ(voy.DestroyDevice(other.device), VOY_SUCCESS);
  EXPECT_EQ(voy.DestroyTarget(other.target), VOY_ERROR_INVALID_HANDLE);
  EXPECT_EQ(voy.DestroyDevice(other.device), VOY_ERROR_INVALID_HANDLE);
  other.device = nullptr;
}

TEST_F(Hostile, ObjectsOfAnotherDevice) {
  Host other(voy);
  VoyFrameEye eye = host.eye();
  eye.target = other.target;
  expect_invalid(host.render(eye), "another device");
  VoyViewDesc desc = host.view_desc();
  desc.scenes = &other.scene;
  expect_invalid(create_view(desc), "another device");
}

}  // namespace
}  // namespace handles_test
