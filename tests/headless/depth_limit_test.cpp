// A host's depth buffer hides splats: each encoding, and what is refused.
#include <voyager/voyager_experiment.h>

#include <algorithm>

#include "hostile.h"
#include "on_backend.h"

namespace depth_limit_test {
namespace {

constexpr double kNear = 0.1;

double encoded(VoyDepthEncoding encoding, double z, double far) {
  if (encoding == VOY_DEPTH_ENCODING_METERS) return z;
  const double a = 1 / (1 - kNear / far), b = -kNear * a;
  return encoding == VOY_DEPTH_ENCODING_STANDARD ? a + b / z : (1 - a) - b / z;
}

double decoded(VoyDepthEncoding encoding, double d, double far) {
  if (encoding == VOY_DEPTH_ENCODING_METERS) return d;
  const double t = encoding == VOY_DEPTH_ENCODING_STANDARD ? 1 - d : d;
  return t == 0 ? kInf : 1 / (1 / far + (1 / kNear - 1 / far) * t);
}

float cleared(VoyDepthEncoding encoding) {
  if (encoding == VOY_DEPTH_ENCODING_METERS) return static_cast<float>(kInf);
  return encoding == VOY_DEPTH_ENCODING_STANDARD ? 1 : 0;
}

constexpr VoyDepthEncoding kEncodings[] = {VOY_DEPTH_ENCODING_METERS, VOY_DEPTH_ENCODING_STANDARD,
                                           VOY_DEPTH_ENCODING_REVERSED};

// A depth buffer of the size of the host's target, with padding that would hide all.
struct DepthBuffer {
  explicit DepthBuffer(VoyDepthEncoding encoding, double far = kInf, size_t padding = 0)
      : pitch(Host::kWidth + padding), values(pitch * Host::kHeight) {
    limit.depth = values.data();
    limit.depthRowPitch = padding == 0 ? 0 : pitch * sizeof(float);
    limit.depthEncoding = encoding;
    limit.nearZ = kNear;
    limit.farZ = far;
  }
  template <class ValueAt>
  void fill(const ValueAt& value_at) {
    const bool far_is_one = limit.depthEncoding == VOY_DEPTH_ENCODING_REVERSED;
    std::fill(values.begin(), values.end(), far_is_one ? 1.0f : 0.0f);
    for (size_t y = 0; y < Host::kHeight; ++y)
      for (size_t x = 0; x < Host::kWidth; ++x)
        values[y * pitch + x] = static_cast<float>(value_at(x, y));
  }
  VoyFrameEye eye(Host& host) const {
    VoyFrameEye eye = host.eye();
    eye.next = &limit;
    return eye;
  }

  size_t pitch;
  std::vector<float> values;
  VoyEyeDepthLimit limit = VOY_EYE_DEPTH_LIMIT_INIT;
};

struct Pixels {
  std::vector<float> color, depth;
  bool operator==(const Pixels& other) const {
    return color == other.color && depth == other.depth;
  }
};

Pixels render(Host& host, const VoyFrameEye& eye) {
  EXPECT_EQ(host.render(eye), VOY_SUCCESS) << host.voy.message();
  return {host.pixels, host.depth};
}

// Steps through the scene, some pixels of no geometry.
double wall(size_t x, size_t y) {
  return (x / 7 + y / 5) % 6 == 0 ? kInf : 6.0 + 0.13 * static_cast<double>((x * 31 + y * 17) % 97);
}

class DepthLimitEncodings : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Of, DepthLimitEncodings, ::testing::ValuesIn(kEachBackend), backend_name);

TEST_P(DepthLimitEncodings, HideTheSameSplats) {
  Host host(voy, device_for(GetParam()));
  const Pixels whole = render(host, host.eye());
  size_t hidden = 0;
  for (const VoyDepthEncoding encoding : kEncodings)
    for (const double far : {100.0, kInf})
      for (const size_t padding : {0u, 5u}) {
        SCOPED_TRACE(std::to_string(encoding) + ", far " + std::to_string(far));
        DepthBuffer buffer(encoding, far, padding), metres(VOY_DEPTH_ENCODING_METERS);
        buffer.fill([&](size_t x, size_t y) {
          const double z = wall(x, y);
          return z < kInf ? encoded(encoding, z, far) : double{cleared(encoding)};
        });
        metres.fill([&](size_t x, size_t y) {
          return wall(x, y) < kInf
                     ? decoded(encoding, double{buffer.values[y * buffer.pitch + x]}, far)
                     : kInf;
        });
        const Pixels found = render(host, buffer.eye(host));
        EXPECT_TRUE(found == render(host, metres.eye(host)));
        for (size_t i = 0; i < whole.depth.size(); ++i) {
          hidden += found.color[4 * i + 3] < whole.color[4 * i + 3];
          ASSERT_LE(found.color[4 * i + 3], whole.color[4 * i + 3]);
          if (wall(i % Host::kWidth, i / Host::kWidth) == kInf) {
            ASSERT_EQ(found.color[4 * i], whole.color[4 * i]);
            ASSERT_EQ(found.depth[i], whole.depth[i]);
          }
        }
        buffer.fill([&](size_t, size_t) { return cleared(encoding); });
        EXPECT_TRUE(render(host, buffer.eye(host)) == whole) << "a cleared buffer hid something";
      }
  EXPECT_GT(hidden, 1000u);
  DepthBuffer nothing(VOY_DEPTH_ENCODING_METERS);
  nothing.fill([](size_t, size_t) { return 0.0; });
  const Pixels hidden_all = render(host, nothing.eye(host));
  EXPECT_EQ(std::count(hidden_all.color.begin(), hidden_all.color.end(), 0.0f),
            static_cast<ptrdiff_t>(hidden_all.color.size()));
  EXPECT_TRUE(render(host, host.eye()) == whole) << "a limit outlived its frame";
}

TEST_F(Hostile, DepthLimitsOutOfRange) {
  DepthBuffer buffer(VOY_DEPTH_ENCODING_REVERSED, 100);
  buffer.fill([](size_t, size_t) { return 0.5; });
  const auto with = [&](auto&& change) {
    VoyEyeDepthLimit limit = buffer.limit;
    change(limit);
    VoyFrameEye eye = host.eye();
    eye.next = &limit;
    return host.render(eye);
  };
  ASSERT_EQ(with([](VoyEyeDepthLimit&) {}), VOY_SUCCESS) << voy.message();
  const std::vector<float> before = host.pixels;
  expect_invalid(with([](VoyEyeDepthLimit& l) { l.depth = nullptr; }), "frame.eyes[0].next.depth:");
  expect_invalid(with([](VoyEyeDepthLimit& l) {
                   l.depth =
                       reinterpret_cast<const float*>(reinterpret_cast<const char*>(l.depth) + 2);
                 }),
                 "aligned");
  const uint64_t packed = uint64_t{4} * Host::kWidth;
  for (const uint64_t pitch : {uint64_t{1}, packed - 4, packed + 2, UINT64_MAX - 3, UINT64_MAX})
    expect_invalid(with([&](VoyEyeDepthLimit& l) { l.depthRowPitch = pitch; }),
                   "frame.eyes[0].next.depthRowPitch:");
  for (const int encoding : {-1, 3, INT32_MAX, INT32_MIN})
    expect_invalid(
        with([&](VoyEyeDepthLimit& l) { l.depthEncoding = bad_enum<VoyDepthEncoding>(encoding); }),
        "depthEncoding");
  expect_invalid(with([](VoyEyeDepthLimit& l) { l.reserved = 1; }), "reserved");
  for (const VoyDepthEncoding encoding : {VOY_DEPTH_ENCODING_STANDARD, VOY_DEPTH_ENCODING_REVERSED})
    for (const double bad : {0.0, -1.0, 1e-19, 1e19, kInf, kNan}) {
      expect_invalid(with([&](VoyEyeDepthLimit& l) { l.depthEncoding = encoding, l.nearZ = bad; }),
                     "nearZ");
      if (bad > 1) continue;
      expect_invalid(with([&](VoyEyeDepthLimit& l) { l.depthEncoding = encoding, l.farZ = bad; }),
                     "farZ");
    }
  expect_invalid(with([](VoyEyeDepthLimit& l) { l.farZ = l.nearZ; }), "frame.eyes[0].next.farZ:");
  EXPECT_EQ(host.pixels, before) << "a refused frame wrote to the target";
  EXPECT_EQ(with([](VoyEyeDepthLimit& l) {
              l.depthEncoding = VOY_DEPTH_ENCODING_METERS;
              l.nearZ = kNan, l.farZ = -1;
            }),
            VOY_SUCCESS)
      << voy.message();
}

TEST_F(Hostile, ChainsOfAnEye) {
  DepthBuffer buffer(VOY_DEPTH_ENCODING_METERS);
  buffer.fill([](size_t, size_t) { return 9.0; });
  VoyEyeDepthLimit first = buffer.limit, second = buffer.limit;
  VoyFrameEye eye = host.eye();
  const auto expect_structure = [&](const char* part) {
    expect_refused(host.render(eye), VOY_ERROR_INVALID_STRUCTURE, part);
  };
  eye.next = &first;
  ASSERT_EQ(host.render(eye), VOY_SUCCESS) << voy.message();
  first.next = &second;
  expect_structure("frame.eyes[0].next: found two structures of type 14");
  first.next = &first;
  expect_structure("two");
  first.next = nullptr, second.next = &first;
  eye.next = &second;
  expect_structure("two");
  first.next = &second;
  expect_structure("two");
  second.next = &eye;
  expect_structure("expected 14");
  eye.next = &eye;
  expect_structure("found a structure of type 12");
  first.next = nullptr;
  eye.next = &first;
  for (const int type : {0, 13, 15, INT32_MAX, -1}) {
    first.type = bad_enum<VoyStructureType>(type);
    expect_structure("frame.eyes[0].next");
  }
  // No other structure knows it.
  first.type = VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT;
  eye.next = nullptr;
  VoyFrame frame = Host::frame(eye);
  frame.next = &first;
  expect_refused(voy.RenderFrame(host.view, &frame), VOY_ERROR_INVALID_STRUCTURE, "VoyFrame.next");
}

TEST(DepthLimit, TheBaselineRefusesIt) {
  const Library voy;
  if (voy.QueryBackend(VOY_BACKEND_CUDA) != VOY_SUCCESS) VOYAGER_SKIP_WITHOUT(CUDA, voy.message());
  Host host(voy, device_for(VOY_BACKEND_CUDA));
  VoyViewDesc desc = host.view_desc();
  VoyExperiment experiment = VOY_EXPERIMENT_INIT;
  experiment.splatting = VOY_SPLATTING_3DGS;
  desc.next = &experiment;
  VoyView baseline = nullptr;
  ASSERT_EQ(voy.CreateView(host.device, &desc, &baseline), VOY_SUCCESS) << voy.message();
  DepthBuffer buffer(VOY_DEPTH_ENCODING_METERS);
  const VoyFrameEye eye = buffer.eye(host);
  const VoyFrame frame = Host::frame(eye);
  EXPECT_EQ(voy.RenderFrame(baseline, &frame), VOY_ERROR_UNSUPPORTED);
  EXPECT_NE(voy.message().find("depth limit"), std::string::npos) << voy.message();
}

}  // namespace
}  // namespace depth_limit_test
