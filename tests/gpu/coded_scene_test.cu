// What a device restores of a compact scene has the bits that the host restores.
#include <cstring>
#include <random>

#include "cuda/scene/device_arrays.cuh"
#include "cuda/scene/device_gaussian.h"
#include "cuda/scene/gaussian_hull.cuh"
#include "cuda/stream/device_pool.h"
#include "runtime/frame/open_streamed.h"
#include "runtime/frame/scene_gaussians.h"
#include "tests/gpu/device_test.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::test {
namespace coded_scene_test {
namespace {

using cuda::Buffer;
using cuda::download;

constexpr int kMostFloats = 3 * sh_coefficients(kMaxShDegree);

template <class Sh>
__global__ void restore(cuda::GaussianView gaussians, Gaussian* shapes, float* sh) {
  const cuda::DeviceArrays<Sh> arrays{gaussians};
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= gaussians.count) return;
  shapes[i] = arrays.gaussian(i);
  shapes[i].mean = arrays.mean(i);
  const Sh own = arrays.sh(i);
#pragma unroll
  for (int k = 0; k < sh_coefficients(Sh::degree(gaussians)); ++k)
#pragma unroll
    for (int c = 0; c < 3; ++c) sh[size_t{i} * kMostFloats + 3 * k + c] = own(k, c);
}

__global__ void bound(const uint32_t* bounds, float2* found, uint32_t count) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= count) return;
  const ShapeCode code{bounds[i], {}};
  found[i] = {cuda::largest_scale(code), cuda::support_radius_squared(code)};
}

__global__ void restore_largest(const int* steps, float* found, uint32_t count) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) found[i] = largest_component(steps + 3 * i);
}

struct Restored {
  std::vector<Gaussian> shapes;
  std::vector<float> sh;  // kMostFloats each
};

Restored restore_all(const cuda::GaussianView& view) {
  const Buffer<Gaussian> shapes(view.count);
  const Buffer<float> sh(size_t{view.count} * kMostFloats);
  // Lower degrees leave the rest of a row as it is, and all of it is read.
  cuda::check(cudaMemset(sh.data(), 0, sh.bytes()), "clear");
  cuda::with_sh(view, [&]<class Sh>() {
    if constexpr (Sh::kCoded)
      restore<Sh><<<(view.count + 127) / 128, 128>>>(view, shapes.data(), sh.data());
    else
      FAIL() << "a compact scene that is not coded";
  });
  cuda::check(cudaGetLastError(), "restore");
  return {download(shapes), download(sh)};
}

class CodedScene : public DeviceTest {
 protected:
  // at: where the device has node `node`.
  void expect_same(const Restored& found, size_t at, const Scene& scene, uint32_t node) {
    const Gaussian expected = gaussian_arrays(scene).gaussian(node);
    ASSERT_EQ(std::memcmp(&expected, &found.shapes[at], sizeof expected), 0) << node;
    std::vector<float> own(sh_floats(scene));
    copy_sh(scene, node, own.data());
    for (size_t k = 0; k < own.size(); ++k)
      ASSERT_EQ(own[k], found.sh[at * kMostFloats + k]) << node << " " << k;
  }
  static Bytes bytes_of(int degree, uint32_t chunk_bytes) {
    return scene_bytes(bake(random_cloud(20000, 71 + static_cast<uint32_t>(degree), degree)),
                       Quality::compact, 0, chunk_bytes);
  }
  std::shared_ptr<const Scene> resident(const Bytes& bytes) {
    return load_scene(source_of(bytes), std::pmr::get_default_resource(), workers);
  }

  Workers workers;
};

TEST_F(CodedScene, GaussiansHaveTheHostsBits) {
  for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes})
    for (int degree = 0; degree <= kMaxShDegree; ++degree) {
      SCOPED_TRACE(degree);
      const auto scene = resident(bytes_of(degree, chunk_bytes));
      ASSERT_TRUE(is_coded(*scene));
      const cuda::DeviceScene on_device(*device(), *scene, workers);
      const Restored found = restore_all(on_device.view());
      for (uint32_t i = 0; i < found.shapes.size(); ++i) {
        expect_same(found, i, *scene, i);
        if (HasFatalFailure()) return;
      }
    }
}

TEST_F(CodedScene, StreamedGaussiansHaveTheHostsBits) {
  for (int degree = 0; degree <= kMaxShDegree; ++degree) {
    SCOPED_TRACE(degree);
    const Bytes bytes = bytes_of(degree, kMinChunkBytes);
    const auto scene = resident(bytes);
    const auto backend = create_backend();
    StreamingDesc desc;
    desc.readers = 0;
    const std::shared_ptr<Scene> streamed =
        open_streamed(source_of(bytes), desc, *backend, std::pmr::get_default_resource(), workers);
    View view(streamed, *backend, {}, std::pmr::get_default_resource(), workers);
    FrameInput input = frame_input(look({3, -6, -24}, {0.1, 0.2, 5}, 240, 150), 0);
    input.wait_resident = true;
    ASSERT_GT(render(view, input).cut.size(), 10000u);
    auto* pool = dynamic_cast<cuda::DevicePool*>(streamed->pool.get());
    ASSERT_NE(pool, nullptr);
    const cuda::GaussianView gaussians = pool->gaussians();
    const uint32_t slot_nodes = pool->slot_nodes();
    const std::vector<SlotIds>& slots = pool->slot_ids();
    std::vector<uint32_t> ids(gaussians.count);
    for (uint32_t at = 0; at < gaussians.count; ++at)
      ids[at] = slots[at / slot_nodes].id(at % slot_nodes);
    const Restored found = restore_all(gaussians);
    const GaussianArrays arrays = gaussian_arrays(*scene);
    size_t there = 0;
    for (size_t at = 0; at < ids.size(); ++at) {
      // What no chunk has filled has no node's mean.
      if (ids[at] >= scene->node_count || !(found.shapes[at].mean == arrays.mean(ids[at])))
        continue;
      ++there;
      expect_same(found, at, *scene, ids[at]);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(there, 10000u);
  }
}

// What culling goes by leaves out nothing that the codes stand for, and adds little.
TEST_F(CodedScene, HullsBoundWhatCodesRestore) {
  std::vector<uint32_t> bounds;
  for (uint32_t q = 0; q < kOpacityCodes; ++q)
    for (const bool leaf : {false, true})
      if (leaf || q < 0x7c00) bounds.push_back(bounds_code(q % kScaleCodes, q, leaf));
  const auto count = static_cast<uint32_t>(bounds.size());
  const Buffer<uint32_t> given = cuda::upload(std::span<const uint32_t>(bounds));
  const Buffer<float2> found(count);
  bound<<<(count + 255) / 256, 256>>>(given.data(), found.data(), count);
  cuda::check(cudaGetLastError(), "bound");
  const std::vector<float2> values = download(found);
  for (uint32_t i = 0; i < count; ++i) {
    const ShapeCode code{bounds[i], {}};
    const float scale = shape_tables().scale[largest_scale_code(code)];
    ASSERT_GE(values[i].x, scale) << bounds[i];
    ASSERT_LE(values[i].x, 1.0001f * scale) << bounds[i];
    const double over = double{restored_log_opacity(code, shape_tables())} - kLogTruthThreshold;
    const double squared = over >= 0 ? 2 * (kRhoMargin + over) : 0;
    ASSERT_GE(values[i].y, squared) << bounds[i];
    ASSERT_LE(values[i].y, std::max(2 * (1e-4 + over), 0.0)) << bounds[i];
  }
}

// Near the middle between two numbers a device looks again in binary64.
TEST_F(CodedScene, LargestComponentsHaveTheHostsBits) {
  constexpr uint32_t kCount = 1 << 22;
  std::mt19937 random(5);
  std::vector<int> steps(3 * size_t{kCount});
  for (size_t i = 0; i < steps.size(); ++i) {
    // Up to the bound, which no sound file has of all three, and up to what one has.
    const int most = i / 3 % 4 == 0 ? kRotationSteps : i / 3 % 4 == 1 ? 300 : 11000;
    steps[i] = std::uniform_int_distribution<int>(-most, most)(random);
  }
  steps[0] = steps[1] = steps[2] = 0;
  const Buffer<int> given = cuda::upload(std::span<const int>(steps));
  const Buffer<float> found(kCount);
  restore_largest<<<kCount / 256, 256>>>(given.data(), found.data(), kCount);
  cuda::check(cudaGetLastError(), "restore_largest");
  const std::vector<float> values = download(found);
  for (uint32_t i = 0; i < kCount; ++i)
    ASSERT_EQ(values[i], largest_component(&steps[3 * size_t{i}])) << i;
}

}  // namespace
}  // namespace coded_scene_test
}  // namespace voyager::test
