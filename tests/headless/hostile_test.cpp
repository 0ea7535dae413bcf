// Values that no sane host passes: an error with a message, no crash, and
// everything still works afterwards. Sanitizer builds watch for the rest.
#include <voyager/voyager_experiment.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cfloat>

#include "hostile.h"

namespace hostile_test {
namespace {

TEST_F(Hostile, ADeviceOfNoKnownChoiceIsRefused) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  constexpr uint32_t kMinor = VOY_MAKE_VERSION(0, 1, 0), kMajor = VOY_MAKE_VERSION(1, 0, 0);
  const uint32_t own = voy.GetVersion();
  for (const uint32_t version :
       {0xffffffffu, own + kMinor, own + kMajor, own + kMajor + kMinor, own + 2 * kMajor}) {
    desc.apiVersion = version;
    expect_refused(create_device(desc), VOY_ERROR_INCOMPATIBLE_VERSION,
                   "expected the major version of");
  }
  desc.apiVersion = own + VOY_MAKE_VERSION(0, 0, 7);
  EXPECT_EQ(create_device(desc), VOY_SUCCESS);
  for (const int backend : {-1, 4, INT32_MAX, INT32_MIN}) {
    desc.backend = bad_enum<VoyBackend>(backend);
    expect_invalid(create_device(desc), "backend");
    expect_invalid(voy.QueryBackend(bad_enum<VoyBackend>(backend)), "backend");
  }
  desc = VOY_DEVICE_DESC_INIT;
  desc.workerThreadCount = UINT32_MAX;
  expect_invalid(create_device(desc), "workerThreadCount");
  desc.workerThreadCount = 0;
  desc.logLevel = bad_enum<VoyLogLevel>(3);
  expect_invalid(create_device(desc), "logLevel");
}

TEST_F(Hostile, AViewOutOfRangeIsRefusedAndItsFieldNamed) {
  const auto with = [&](auto&& change) {
    VoyViewDesc desc = host.view_desc();
    change(desc);
    return create_view(desc);
  };
  EXPECT_EQ(with([](VoyViewDesc&) {}), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(with([](VoyViewDesc& d) { d.instanceCount = 0, d.scenes = nullptr; }), VOY_SUCCESS)
      << voy.message();
  expect_invalid(with([](VoyViewDesc& d) { d.scenes = nullptr; }), "scenes");
  for (const uint32_t count : {65u, UINT32_MAX})
    expect_refused(with([&](VoyViewDesc& d) { d.instanceCount = count, d.scenes = nullptr; }),
                   VOY_ERROR_UNSUPPORTED, "instanceCount");
  for (const uint32_t count : {3u, UINT32_MAX})
    expect_refused(with([&](VoyViewDesc& d) { d.eyeCount = count; }), VOY_ERROR_UNSUPPORTED,
                   "eyeCount");
  expect_invalid(with([](VoyViewDesc& d) { d.eyeCount = 0; }), "eyeCount");
  for (const uint32_t size : {0u, 16385u, UINT32_MAX}) {
    expect_invalid(with([&](VoyViewDesc& d) { d.maxWidth = size; }), "maxWidth");
    expect_invalid(with([&](VoyViewDesc& d) { d.maxHeight = size; }), "maxHeight");
  }
  for (const double tau : {kNan, kInf, -kInf, -1e-9}) {
    expect_invalid(with([&](VoyViewDesc& d) { d.tau = tau; }), "desc.tau: found");
    expect_invalid(voy.SetViewTau(host.view, tau), ": tau: found");
  }
  for (const int choice : {-1, 9, INT32_MAX}) {
    expect_invalid(with([&](VoyViewDesc& d) { d.lod = bad_enum<VoyLod>(choice); }), "lod");
    expect_invalid(with([&](VoyViewDesc& d) { d.antialias = bad_enum<VoyAntialias>(choice); }),
                   "antialias");
  }
  expect_invalid(with([](VoyViewDesc& d) { d.reserved = 1; }), "reserved");
}

TEST_F(Hostile, AnExperimentOfNoKnownChoiceIsRefused) {
  VoyViewDesc desc = host.view_desc();
  const auto with = [&](auto&& change) {
    VoyExperiment experiment = VOY_EXPERIMENT_INIT;
    change(experiment);
    desc.next = &experiment;
    return create_view(desc);
  };
  using E = VoyExperiment;
  EXPECT_EQ(with([](E&) {}), VOY_SUCCESS) << voy.message();
  for (const int choice : {-1, 9, INT32_MAX}) {
    expect_invalid(with([&](E& e) { e.selection = bad_enum<VoySelection>(choice); }), "selection");
    expect_invalid(with([&](E& e) { e.search = bad_enum<VoySearch>(choice); }), "search");
    expect_invalid(with([&](E& e) { e.alphaFilter = bad_enum<VoyAlphaFilter>(choice); }),
                   "alphaFilter");
    expect_invalid(with([&](E& e) { e.exponential = bad_enum<VoyExponential>(choice); }),
                   "exponential");
    expect_invalid(with([&](E& e) { e.splatting = bad_enum<VoySplatting>(choice); }), "splatting");
  }
  expect_invalid(with([](E& e) { e.lutSize = 4097; }), "lutSize");
  expect_invalid(with([](E& e) { e.truth = 2; }), "truth");
  expect_invalid(with([](E& e) { e.reserved = 1; }), "reserved");
  desc.antialias = VOY_ANTIALIAS_OFF;
  expect_invalid(with([](E& e) { e.truth = 1; }), "truth");
  desc.lod = VOY_LOD_ALL_LEAVES;
  expect_invalid(with([](E& e) { e.selection = VOY_SELECTION_BLOCKS; }), "selection");
}

TEST_F(Hostile, ATargetOutOfRangeIsRefusedAndItsFieldNamed) {
  const auto with = [&](auto&& change) {
    VoyTargetDesc desc = host.target_desc();
    change(desc);
    return create_target(desc);
  };
  const auto misaligned = [](auto* pointer) {
    return reinterpret_cast<decltype(pointer)>(reinterpret_cast<uintptr_t>(pointer) + 1);
  };
  EXPECT_EQ(with([](VoyTargetDesc&) {}), VOY_SUCCESS) << voy.message();
  for (const uint32_t size : {0u, 16385u, UINT32_MAX}) {
    expect_invalid(with([&](VoyTargetDesc& d) { d.width = size; }), "width");
    expect_invalid(with([&](VoyTargetDesc& d) { d.height = size; }), "height");
  }
  const uint64_t packed = uint64_t{16} * Host::kWidth;
  for (const uint64_t pitch : {uint64_t{1}, packed - 4, packed + 1, UINT64_MAX, UINT64_MAX - 3,
                               UINT64_MAX / Host::kHeight - 3}) {
    expect_invalid(with([&](VoyTargetDesc& d) { d.colorRowPitch = pitch; }), "colorRowPitch");
    if (pitch > packed || pitch == 1)
      expect_invalid(with([&](VoyTargetDesc& d) { d.depthRowPitch = pitch; }), "depthRowPitch");
  }
  expect_invalid(with([](VoyTargetDesc& d) { d.color = nullptr; }), "color");
  expect_invalid(with([](VoyTargetDesc& d) { d.colorFormat = VOY_COLOR_FORMAT_NONE; }), "color");
  expect_invalid(with([](VoyTargetDesc& d) {
                   d.colorFormat = VOY_COLOR_FORMAT_NONE;
                   d.color = nullptr;
                   d.depth = nullptr;
                 }),
                 "neither");
  expect_invalid(with([&](VoyTargetDesc& d) { d.color = misaligned(static_cast<char*>(d.color)); }),
                 "aligned");
  expect_invalid(with([&](VoyTargetDesc& d) { d.depth = misaligned(d.depth); }), "aligned");
  for (const int choice : {-1, 4, INT32_MAX})
    expect_invalid(
        with([&](VoyTargetDesc& d) { d.colorFormat = bad_enum<VoyColorFormat>(choice); }),
        "colorFormat");
  expect_invalid(with([](VoyTargetDesc& d) { d.kind = bad_enum<VoyTargetKind>(1); }), "kind");
}

TEST_F(Hostile, APoseOrFrustumOutOfRangeIsRefusedAndItsFieldNamed) {
  const std::vector<float> before = host.pixels;
  const auto with = [&](auto&& change) {
    VoyFrameEye eye = host.eye();
    change(eye);
    return host.render(eye);
  };
  for (const double bad : {kNan, kInf, -kInf, 1e18, -DBL_MAX})
    for (int i = 0; i < 3; ++i)
      expect_invalid(with([&](VoyFrameEye& e) { e.pose.position[i] = bad; }), "position");
  for (const double bad : {kNan, kInf, -kInf})
    for (int i = 0; i < 4; ++i)
      expect_invalid(with([&](VoyFrameEye& e) { e.pose.orientation[i] = bad; }), "orientation");
  expect_invalid(with([](VoyFrameEye& e) { e.pose.orientation[3] = 0; }), "orientation");
  for (const double bad : {kNan, kInf, 1e5})
    for (double VoyFrustum::*side :
         {&VoyFrustum::left, &VoyFrustum::right, &VoyFrustum::up, &VoyFrustum::down})
      expect_invalid(with([&](VoyFrameEye& e) { e.frustum.*side = bad; }), "frustum");
  expect_invalid(with([](VoyFrameEye& e) { std::swap(e.frustum.left, e.frustum.right); }), "left");
  expect_invalid(with([](VoyFrameEye& e) { std::swap(e.frustum.up, e.frustum.down); }), "down");
  expect_invalid(with([](VoyFrameEye& e) { e.frustum.left = e.frustum.right; }), "left");
  expect_invalid(with([](VoyFrameEye& e) { e.frustum = {}; }), "frustum");
  expect_refused(with([](VoyFrameEye& e) { e.target = nullptr; }), VOY_ERROR_INVALID_HANDLE,
                 "frame.eyes[0].target: target: found NULL");
  expect_invalid(with([](VoyFrameEye& e) { e.layer = 1; }), "frame.eyes[0].layer");
  expect_invalid(with([](VoyFrameEye& e) { e.reserved = 1; }), "frame.eyes[0].reserved");
  EXPECT_EQ(host.pixels, before) << "a refused frame wrote to the target";
  EXPECT_EQ(with([](VoyFrameEye& e) {
              e.pose = VOY_POSE_INIT;
              e.frustum = VOY_FRUSTUM_INIT;
            }),
            VOY_SUCCESS)
      << voy.message();
  // Any length will do, down to the smallest and up to the largest.
  ASSERT_EQ(host.render(), VOY_SUCCESS);
  const std::vector<float> image = host.pixels;
  for (const double length : {5e-324, 1e-200, 7.0, DBL_MAX}) {
    ASSERT_EQ(with([&](VoyFrameEye& e) { e.pose.orientation[3] = length; }), VOY_SUCCESS);
    EXPECT_EQ(host.pixels, image) << length;
  }
}

TEST_F(Hostile, AFrameOutOfRangeIsRefusedAndItsFieldNamed) {
  const VoyFrameEye eye = host.eye();
  const auto with = [&](auto&& change) {
    VoyFrame frame = Host::frame(eye);
    change(frame);
    return voy.RenderFrame(host.view, &frame);
  };
  for (const uint32_t count : {0u, 2u, UINT32_MAX})
    expect_invalid(with([&](VoyFrame& f) { f.eyeCount = count; }), "eyeCount");
  expect_invalid(with([](VoyFrame& f) { f.eyes = nullptr; }), "eyes");
  for (const double z : {0.0, -1.0, kNan, kInf})
    expect_invalid(with([&](VoyFrame& f) { f.nearZ = z; }), "nearZ");
  for (const double value : {kNan, kInf})
    for (int i = 0; i < 3; ++i)
      expect_invalid(with([&](VoyFrame& f) { f.background[i] = static_cast<float>(value); }),
                     ("frame.background[" + std::to_string(i) + "]").c_str());
  expect_invalid(with([](VoyFrame& f) { f.reserved = 1; }), "reserved");

  VoyInstancePose instance = VOY_INSTANCE_POSE_INIT;
  instance.pose.orientation[3] = -2;
  const auto with_instance = [&] {
    return with([&](VoyFrame& f) { f.instances = &instance, f.instanceCount = 1; });
  };
  EXPECT_EQ(with_instance(), VOY_SUCCESS) << voy.message();
  for (const double scale : {0.0, -1.0, 9e-10, 1.1e9, kNan, kInf}) {
    instance.scale = scale;
    expect_invalid(with_instance(), "frame.instances[0].scale");
  }
  instance.scale = 1;
  for (const double bad : {kNan, kInf, -1e18}) {
    instance.pose.position[1] = bad;
    expect_invalid(with_instance(), "frame.instances[0].pose.position");
  }
  instance.pose.position[1] = 1e-300;
  instance.pose.orientation[0] = kNan;
  expect_invalid(with_instance(), "frame.instances[0].pose.orientation");
  instance.pose.orientation[0] = instance.pose.orientation[3] = 0;
  expect_invalid(with_instance(), "frame.instances[0].pose.orientation");
  instance.pose.orientation[3] = 5;
  for (const double scale : {1e-9, 1e9}) {
    instance.scale = scale;
    EXPECT_EQ(with_instance(), VOY_SUCCESS) << voy.message();
  }
  // The eye would come to lie 1e26 m from the scene's middle.
  instance.scale = 1e-9;
  instance.pose.position[1] = 1e17;
  expect_invalid(with_instance(),
                 "frame.eyes[0].pose.position: found -1e+26 on axis 1 from the scene's origin of "
                 "instance 0");
}

TEST_F(Hostile, AnInstanceOutOfRangeIsRefusedAndTheImageStays) {
  ASSERT_EQ(host.render(), VOY_SUCCESS);
  const std::vector<float> image = host.pixels;
  const auto with = [&](auto&& change) {
    VoyInstance instance = VOY_INSTANCE_INIT;
    instance.scene = host.scene;
    change(instance);
    return voy.SetViewInstances(host.view, 1, &instance);
  };
  using I = VoyInstance;
  EXPECT_EQ(with([](I&) {}), VOY_SUCCESS) << voy.message();
  for (const double scale : {0.0, -1.0, 9e-10, 1.1e9, kNan, kInf})
    expect_invalid(with([&](I& i) { i.scale = scale; }), "instances[0].scale: found");
  for (const double bad : {kNan, kInf, -1e18})
    expect_invalid(with([&](I& i) { i.pose.position[1] = bad; }), "instances[0].pose.position");
  for (const double bad : {kNan, kInf})
    expect_invalid(with([&](I& i) { i.pose.orientation[2] = bad; }), "pose.orientation");
  expect_invalid(with([](I& i) { i.pose.orientation[3] = 0; }), "found zero, expected a rotation");
  for (const double bad : {-1e-6, 1.000001, kNan, kInf, -kInf})
    expect_invalid(with([&](I& i) { i.opacity = static_cast<float>(bad); }),
                   "instances[0].opacity: found");
  for (int axis = 0; axis < 3; ++axis) {
    expect_invalid(with([&](I& i) { i.clipMin[axis] = kNan; }), "instances[0].clipMin[");
    expect_invalid(with([&](I& i) { i.clipMax[axis] = kNan; }), "instances[0].clipMax[");
    expect_invalid(with([&](I& i) { i.clipMin[axis] = 2, i.clipMax[axis] = 1.999999; }),
                   "found 1.999999, expected a number >= clipMin");
    expect_invalid(with([&](I& i) { i.clipMin[axis] = kInf; }), "clipMax");
  }
  expect_invalid(with([](I& i) { i.reserved = 1; }), "instances[0].reserved");
  for (const int type : {0, 13, 39, 41, -1, INT32_MAX})
    expect_refused(with([&](I& i) { i.type = bad_enum<VoyStructureType>(type); }),
                   VOY_ERROR_INVALID_STRUCTURE, "instances[0].type");
  expect_refused(with([&](I& i) { i.next = &i; }), VOY_ERROR_INVALID_STRUCTURE, "next");
  expect_refused(with([](I& i) { i.scene = nullptr; }), VOY_ERROR_INVALID_HANDLE,
                 "instances[0].scene: scene: found NULL");
  expect_invalid(voy.SetViewInstances(host.view, 1, nullptr), "instances");
  for (const uint32_t count : {65u, UINT32_MAX})
    expect_refused(voy.SetViewInstances(host.view, count, nullptr), VOY_ERROR_UNSUPPORTED,
                   "count: found");
  EXPECT_EQ(voy.SetViewInstances(nullptr, 0, nullptr), VOY_ERROR_INVALID_HANDLE);
  Host other(voy);
  expect_invalid(with([&](I& i) { i.scene = other.scene; }),
                 "instances[0].scene: found a scene of another device");
  ASSERT_EQ(host.render(), VOY_SUCCESS);
  EXPECT_EQ(host.pixels, image) << "a refused list changed the view";
  // What is allowed, to its ends.
  EXPECT_EQ(with([](I& i) { i.opacity = 0; }), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(with([](I& i) { i.opacity = 1e-45f; }), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(host.render(), VOY_SUCCESS) << voy.message();
  for (const double limit : {-kInf, -DBL_MAX, 0.0, DBL_MAX, kInf}) {
    EXPECT_EQ(with([&](I& i) { i.clipMin[0] = i.clipMax[0] = limit; }), VOY_SUCCESS);
    EXPECT_EQ(host.render(), VOY_SUCCESS) << voy.message();
  }
  EXPECT_EQ(with([](I& i) { i.clipMin[1] = -DBL_MAX, i.clipMax[1] = kInf; }), VOY_SUCCESS);
  ASSERT_EQ(host.render(), VOY_SUCCESS);
  EXPECT_EQ(host.pixels, image);
}

TEST_F(Hostile, ATargetLargerThanTheViewIsRefused) {
  VoyViewDesc desc = host.view_desc();
  desc.maxWidth = Host::kWidth - 1;
  VoyView small = nullptr;
  ASSERT_EQ(voy.CreateView(host.device, &desc, &small), VOY_SUCCESS);
  const VoyFrameEye eye = host.eye();
  const VoyFrame frame = Host::frame(eye);
  expect_invalid(voy.RenderFrame(small, &frame), "95 x 64");
}

TEST_F(Hostile, QueriesWithoutAFrameOrACutAreRefused) {
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  expect_invalid(voy.GetFrameStats(host.view, &stats), "without a rendered frame");
  uint32_t count = 77;
  expect_refused(voy.GetViewCut(host.view, 0, 0, nullptr, &count), VOY_ERROR_UNSUPPORTED, "cut");
  expect_invalid(voy.GetViewCut(host.view, 1, 0, nullptr, &count), "instance");
  expect_invalid(voy.GetViewCut(host.view, UINT32_MAX, 0, nullptr, &count), "instance");
  EXPECT_EQ(count, 77u);
  VoySceneNote note = {};
  ASSERT_EQ(voy.GetSceneNotes(host.scene, 0, nullptr, &count), VOY_SUCCESS);
  ASSERT_GT(count, 1u);
  EXPECT_EQ(voy.GetSceneNotes(host.scene, 1, &note, &count), VOY_INCOMPLETE);
  EXPECT_EQ(note.type, VOY_STRUCTURE_TYPE_SCENE_NOTE);
  EXPECT_NE(note.what[0], '\0');
}

TEST_F(Hostile, WhatASceneDoesNotNeedHasNoCount) {
  uint32_t count = 0;
  ASSERT_EQ(voy.GetSceneNotes(host.scene, 0, nullptr, &count), VOY_SUCCESS);
  std::vector<VoySceneNote> notes(count);
  ASSERT_EQ(voy.GetSceneNotes(host.scene, count, notes.data(), &count), VOY_SUCCESS);
  int omitted = 0;
  for (const VoySceneNote& note : notes) {
    if (note.kind != VOY_SCENE_NOTE_KIND_OMITTED) continue;
    EXPECT_EQ(note.count, 0u) << note.what;
    EXPECT_GT(note.bytes, 0u) << note.what;
    ++omitted;
  }
  EXPECT_EQ(omitted, 2) << "the tree, and the SH bands above degree 1";
}

TEST_F(Hostile, FrustumHelpersRefuseWhatIsNoFrustum) {
  VoyFrustum f = {1, 2, 3, 4};
  for (const double bad : {kNan, kInf, 1.5707963267948968, -3.0}) {
    expect_invalid(voy.FrustumFromAngles(bad, 1, 1, -1, &f), "left");
    expect_invalid(voy.FrustumFromIntrinsics(kNan, 1, 1, 1, 1, 1, &f), "fx");
  }
  expect_invalid(voy.FrustumFromAngles(1, 1, 1, -1, &f), "left");
  expect_invalid(voy.FrustumFromIntrinsics(1, 0, 1, 1, 1, 1, &f), "fy");
  // In range one by one, but no frustum together.
  expect_invalid(voy.FrustumFromAngles(-1.5707963267948963, 1, 1, -1, &f), "frustum.left");
  expect_invalid(voy.FrustumFromAngles(0.5, 0.5 + 1e-9, 1, -1, &f), "frustum.left");
  expect_invalid(voy.FrustumFromIntrinsics(1e-300, 1, 1e300, 0, 1, 1, &f), "frustum.left");
  expect_invalid(voy.FrustumFromIntrinsics(1, 1, 0, 0, 1, 1e5, &f), "frustum.down: found -100000");
  expect_invalid(voy.FrustumFromIntrinsics(1e9, 1, 0, 0, 1, 1, &f), "frustum.left");
  expect_invalid(voy.FrustumFromIntrinsics(-DBL_MAX, 1, 0, 0, 1, 1, &f), "found -1.797693135e+308");
  EXPECT_EQ(f.left, 1) << "a refused call wrote its output";
  ASSERT_EQ(voy.FrustumFromIntrinsics(500, 400, 320, 250, 640, 480, &f), VOY_SUCCESS);
  EXPECT_EQ(f.left, -0.64);
  EXPECT_EQ(f.right, 0.64);
  EXPECT_EQ(f.up, 0.625);
  EXPECT_EQ(f.down, -0.575);
  ASSERT_EQ(voy.FrustumFromAngles(-0.5, 0.6, 0.7, -0.8, &f), VOY_SUCCESS);
  EXPECT_EQ(f.right, std::tan(0.6));
}

TEST_F(Hostile, WhatIsNoSceneIsRefused) {
  VoyScene scene = nullptr;
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  const auto open = [&] { return voy.OpenScene(host.device, &desc, &scene); };
  expect_invalid(open(), "neither");
  VoyByteSource source = host.bytes.source();
  desc.source = &source;
  desc.path = "x";
  expect_invalid(open(), "both");
  desc.path = nullptr;
  source.read = nullptr;
  expect_invalid(open(), "read");
  desc.source = nullptr;
  for (const char* path : {"", "/nonexistent/scene.voy"}) {
    desc.path = path;
    EXPECT_EQ(open(), VOY_ERROR_FILE_NOT_FOUND) << voy.message();
  }
  desc.path = "/";
  expect_refused(open(), VOY_ERROR_REFUSED_INPUT,
                 "found a directory, expected a file, or a folder with lod-meta.json");
  desc.path = "/dev/zero";
  expect_refused(open(), VOY_ERROR_REFUSED_INPUT, "character device");
  EXPECT_EQ(scene, nullptr);
}

// Nobody ever writes to it, so a reader would wait for ever.
TEST_F(Hostile, AFifoIsRefusedAtOnce) {
  const std::string path = ::testing::TempDir() + "fifo-" + std::to_string(::getpid()) + ".voy";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  for (const void* next :
       {static_cast<const void*>(nullptr), static_cast<const void*>(&streaming)}) {
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.next = next;
    desc.path = path.c_str();
    VoyScene scene = nullptr;
    expect_refused(voy.OpenScene(host.device, &desc, &scene), VOY_ERROR_REFUSED_INPUT,
                   "found a FIFO");
  }
  ::unlink(path.c_str());
}

}  // namespace
}  // namespace hostile_test
