// A host that waits for the device sleeps, and copies of images and of cuts that the host found are
// the device's work alone.
#include <time.h>

#include "cuda/frame/frame_image.h"
#include "cuda/search/search.h"
#include "runtime/base/clock.h"
#include "tests/gpu/frames_in_flight.h"

namespace voyager::test {
namespace frame_wait_test {
namespace {

// Of this thread.
double cpu_milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

class FrameWait : public FramesInFlight {
 protected:
  // `wait` waits for what was held back.
  template <class Wait>
  static void expect_asleep(const char* name, const Wait& wait) {
    SCOPED_TRACE(name);
    const Stopwatch time;
    const double before = cpu_milliseconds();
    wait();
    EXPECT_GT(time.milliseconds(), kHeld / 2) << "there was nothing to wait for";
    EXPECT_LT(cpu_milliseconds() - before, kHeld / 4) << "it spins";
  }
};

TEST_F(FrameWait, TheHostSleeps) {
  const std::shared_ptr<const Scene> scene = flat_scene(random_cloud(2000, 40, 0));
  const auto drawn = pipeline(scene);
  const Camera small = look({0, 0, -24}, {0, 0, 0}, 64, 40),
               large = look({0, 0, -24}, {0, 0, 0}, 640, 400);
  const auto ring = make_ring(large.width, large.height);
  FrameStats stats;
  drawn->submit(into(*ring, small), true);  // which loads the kernels
  ASSERT_TRUE(drawn->finish(true, stats));

  hold_back(*ring);
  expect_asleep("a ring", [&] { ring->wait(); });
  hold_back(*ring);
  drawn->submit(into(*ring, small), false);
  expect_asleep("a frame", [&] { drawn->finish(true, stats); });
  hold_back(*ring);
  drawn->submit(into(*ring, small), false);
  expect_asleep("a larger frame", [&] { drawn->submit(into(*ring, large), false); });
  ring->wait();
}

TEST_F(FrameWait, AnImagesCopyIsTheDevices) {
  const auto on = device();
  on->use();
  constexpr uint32_t kWidth = 1280, kHeight = 720, kPitch = kWidth + 3, kLeft = 7;
  std::vector<uint32_t> color(size_t{kPitch} * kHeight, kLeft), depth = color;
  FrameEye eye;
  Image& image = eye.image;
  image.format = ColorFormat::rgba8;
  image.width = kWidth, image.height = kHeight;
  image.color = color.data();
  image.depth = reinterpret_cast<float*>(depth.data());
  image.color_pitch = image.depth_pitch = kPitch * sizeof(uint32_t);
  cuda::FrameImage drawn;
  EXPECT_FALSE(drawn.fits(eye));
  drawn.fit(eye);
  EXPECT_TRUE(drawn.fits(eye)) << "the next frame allocates again";

  const cuda::RasterTarget target = drawn.target(eye, {});
  const cuda::Stream stream;
  constexpr size_t kBytes = size_t{kWidth} * kHeight * sizeof(uint32_t);
  cuda::give_head_start(stream.get(), 100'000'000);
  cuda::check(cudaMemsetAsync(target.color, 0x5a, kBytes, stream.get()), "a picture");
  cuda::check(cudaMemsetAsync(target.depth, 0x3c, kBytes, stream.get()), "its depth");
  EXPECT_TRUE(drawn.fetch(image, stream.get()));
  EXPECT_EQ(cudaStreamQuery(stream.get()), cudaErrorNotReady) << "the host copied";
  stream.wait();
  FrameStats stats;
  drawn.resolve(image, workers, stats);
  using Words = std::vector<uint32_t>;
  for (const auto& [plane, value] :
       {std::pair(&color, 0x5a5a5a5au), std::pair(&depth, 0x3c3c3c3cu)})
    for (uint32_t y = 0; y < kHeight; ++y) {
      const auto row = plane->begin() + y * kPitch;
      ASSERT_EQ(Words(row, row + kWidth), Words(kWidth, value)) << "row " << y;
      ASSERT_EQ(Words(row + kWidth, row + kPitch), Words(kPitch - kWidth, kLeft)) << "row " << y;
    }
}

TEST_F(FrameWait, AnImageWithoutMemoryIsNotCopied) {
  FrameEye eye;
  eye.image.format = ColorFormat::rgba8;
  eye.image.width = eye.image.height = 16;
  cuda::FrameImage drawn;
  drawn.fit(eye);
  const cuda::Stream stream;
  EXPECT_FALSE(drawn.fetch(eye.image, stream.get()));
}

// As of a scene with damaged chunks. More nodes than a driver copies out of pageable memory at
// once.
TEST_F(FrameWait, ACutThatTheHostFoundIsTheDevicesToFetch) {
  const auto on = device();
  on->use();
  const auto scene = baked_scene(random_cloud(40'000, 40, 0));
  const auto search = cuda::create_host_cut_search(scene, Search::temporal, workers);
  const cuda::Stream stream;
  const CutQuery fine{{0, 0, -30}, 1e-9f}, coarse{{0, 0, -3000}, 0.1f};
  std::vector<uint32_t> fine_cut, coarse_cut;
  std::vector<float> weights;
  for (int i = 0; i < 3; ++i) search->find(fine, stream.get());  // so that each has its memory
  search->read(fine_cut, weights);
  ASSERT_GT(fine_cut.size(), 20'000u);
  const cuda::Buffer<uint32_t> kept(fine_cut.size());

  cuda::give_head_start(stream.get(), 100'000'000);
  search->find(fine, stream.get());
  cuda::check(cudaMemcpyAsync(kept.data(), search->list().nodes, kept.bytes(),
                              cudaMemcpyDeviceToDevice, stream.get()),
              "a cut");
  // The next one leaves that one alone.
  search->find(coarse, stream.get());
  search->read(coarse_cut, weights);
  EXPECT_EQ(cudaStreamQuery(stream.get()), cudaErrorNotReady) << "the host copied";
  EXPECT_LT(coarse_cut.size(), fine_cut.size() / 10);
  search->find(fine, stream.get());
  EXPECT_EQ(cudaStreamQuery(stream.get()), cudaErrorNotReady) << "the host waited too soon";
  search->find(fine, stream.get());  // which waits for the first of three in flight
  stream.wait();
  EXPECT_EQ(cuda::download(kept), fine_cut);
}

}  // namespace
}  // namespace frame_wait_test
}  // namespace voyager::test
