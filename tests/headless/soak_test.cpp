// A host that never rests: scenes that open and close, views and targets of changing sizes, budgets
// and jumps, on two threads at once. Nothing is lost, and nothing leaks.
#include <malloc.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <random>
#include <thread>

#include "baked_scene.h"
#include "counting_allocator.h"
#include "on_backend.h"

namespace soak_test {
namespace {

constexpr std::array<int, 3> kGaussians = {20000, 6000, 1500};
constexpr int kThreads = 2, kViewsOfThread = 2;
constexpr uint32_t kLargest = 128;  // pixels of a side

double seconds_wanted() {
  const char* wanted = std::getenv("VOYAGER_SOAK_SECONDS");
  return wanted != nullptr ? std::atof(wanted) : 0.5;
}

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  size_t below(size_t count) { return random_() % count; }
  bool one_in(size_t count) { return below(count) == 0; }

 private:
  std::mt19937 random_;
};

// The scenes that both threads draw, and either may close and open at any moment.
class Scenes {
 public:
  Scenes(const Library& voy, VoyDevice device) : voy_(voy), device_(device) {
    for (size_t i = 0; i < kGaussians.size(); ++i) {
      bytes_[i].bytes = baked_bytes(kGaussians[i]);
      whole_[i] = opened(i, nullptr);
      VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
      streamed_[i] = opened(i, &streaming);
    }
  }
  VoyScene streamed(size_t i) {
    const std::lock_guard lock(mutex_);
    return streamed_[i];
  }
  // In memory as a whole; stays.
  VoyScene whole(size_t i) const { return whole_[i]; }

  void reopen(size_t i, Dice& dice) {
    VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
    const double start[3] = {dice.between(-20, 20), 0, dice.between(-20, 20)};
    if (dice.one_in(2)) streaming.startPosition = start;
    if (dice.one_in(2)) streaming.memoryBudget = static_cast<uint64_t>(dice.between(3e5, 4e6));
    const VoyScene made = opened(i, &streaming);
    VoyScene old = made;
    if (made != nullptr) {
      const std::lock_guard lock(mutex_);
      std::swap(old, streamed_[i]);
    }
    EXPECT_EQ(voy_.CloseScene(old), VOY_SUCCESS) << voy_.message();
  }
  // The other thread may have closed it.
  void rebudget(size_t i, Dice& dice) {
    const VoyResult result = voy_.SetSceneMemoryBudget(
        streamed(i), dice.one_in(3) ? 0 : static_cast<uint64_t>(dice.between(1e5, 4e6)));
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_OVER_BUDGET ||
                result == VOY_ERROR_INVALID_HANDLE)
        << voy_.message();
  }

 private:
  VoyScene opened(size_t i, const VoySceneStreaming* streaming) {
    const VoyByteSource source = bytes_[i].source();
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.next = streaming;
    desc.source = &source;
    VoyScene scene = nullptr;
    const VoyResult result = voy_.OpenScene(device_, &desc, &scene);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_OVER_BUDGET) << voy_.message();
    return scene;
  }

  const Library& voy_;
  VoyDevice device_;
  std::array<BytesHost, kGaussians.size()> bytes_;
  std::array<VoyScene, kGaussians.size()> whole_{}, streamed_{};
  std::mutex mutex_;
};

// A view, its target, and where it looks from. One thread's.
class Viewer {
 public:
  Viewer(const Library& voy, VoyDevice device, Scenes& scenes, Dice& dice)
      : voy_(voy), device_(device), scenes_(scenes), dice_(dice) {
    make_anew();
  }
  // Another size, other scenes.
  void make_anew() {
    width_ = static_cast<uint32_t>(1 + dice_.below(kLargest));
    height_ = static_cast<uint32_t>(1 + dice_.below(kLargest));
    count_ = 1 + dice_.below(2);
    for (size_t& shown : shown_) shown = dice_.below(kGaussians.size());
    EXPECT_EQ(voy_.DestroyTarget(target_), VOY_SUCCESS) << voy_.message();
    pixels_.assign(size_t{width_} * height_ * 4, 0);
    target_ = target_of(pixels_);
    make_view();
  }
  void act() {
    if (dice_.one_in(40)) return make_anew();
    if (dice_.one_in(20)) jump();
    if (dice_.one_in(30)) set_level_of_detail();
    if (dice_.one_in(15)) change_instances();
    if (dice_.one_in(10)) return stand_still();
    position_[0] += dice_.between(-0.3, 0.3);
    yaw_ += dice_.between(-0.05, 0.05);
    drawn_ += draw(view_, target_, 0) == VOY_SUCCESS;
  }
  int drawn() const { return drawn_; }
  int compared() const { return compared_; }

 private:
  // Other scenes, or the same ones looking different. A view whose scene was closed goes on.
  void change_instances() {
    if (dice_.one_in(2)) {
      count_ = dice_.below(shown_.size() + 1);
      for (size_t& shown : shown_) shown = dice_.below(kGaussians.size());
    }
    for (VoyInstance& look : looks_) {
      look = VOY_INSTANCE_INIT;
      look.pose.position[1] = dice_.between(-2, 2);
      if (dice_.one_in(2)) look.opacity = static_cast<float>(dice_.between(0, 1));
      if (dice_.one_in(2)) look.clipMin[0] = dice_.between(-20, 0);
    }
    VoyResult result = VOY_ERROR_INVALID_HANDLE;  // a scene may be closed between the two calls
    while (result == VOY_ERROR_INVALID_HANDLE) {
      std::array<VoyScene, 2> shown{};
      for (size_t i = 0; i < count_; ++i) shown[i] = scenes_.streamed(shown_[i]);
      result = set_instances(view_, shown);
    }
    EXPECT_EQ(result, VOY_SUCCESS) << voy_.message();
  }
  VoyResult set_instances(VoyView view, const std::array<VoyScene, 2>& shown) const {
    std::array<VoyInstance, 2> list = looks_;
    for (size_t i = 0; i < count_; ++i) list[i].scene = shown[i];
    return voy_.SetViewInstances(view, static_cast<uint32_t>(count_), list.data());
  }
  void make_view() {
    looks_.fill(VoyInstance VOY_INSTANCE_INIT);
    EXPECT_EQ(voy_.DestroyView(view_), VOY_SUCCESS) << voy_.message();
    view_ = nullptr;
    // A scene may be closed between the two calls.
    VoyResult result = VOY_ERROR_INVALID_HANDLE;
    while (result == VOY_ERROR_INVALID_HANDLE || result == VOY_ERROR_SCENE_CLOSED) {
      std::array<VoyScene, 2> shown{};
      for (size_t i = 0; i < count_; ++i) shown[i] = scenes_.streamed(shown_[i]);
      result = create_view(shown, view_);
    }
    EXPECT_EQ(result, VOY_SUCCESS) << voy_.message();
  }
  VoyResult create_view(const std::array<VoyScene, 2>& shown, VoyView& view) const {
    VoyViewDesc desc = VOY_VIEW_DESC_INIT;
    desc.instanceCount = static_cast<uint32_t>(count_);
    desc.scenes = shown.data();
    desc.maxWidth = width_;
    desc.maxHeight = height_;
    desc.tau = tau_;
    return voy_.CreateView(device_, &desc, &view);
  }
  VoyTarget target_of(std::vector<float>& pixels) const {
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.colorFormat = VOY_COLOR_FORMAT_RGBA32F;
    desc.width = width_;
    desc.height = height_;
    desc.color = pixels.data();
    VoyTarget target = nullptr;
    EXPECT_EQ(voy_.CreateTarget(device_, &desc, &target), VOY_SUCCESS) << voy_.message();
    return target;
  }
  void jump() {
    position_ = {dice_.between(-30, 30), dice_.between(-8, 8), dice_.between(-30, 30)};
    yaw_ = dice_.between(-3.2, 3.2);
  }
  void set_level_of_detail() {
    VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
    budget.milliseconds = dice_.between(0.1, 5);
    tau_ = dice_.between(0, 20);
    const VoyResult result =
        dice_.one_in(2) ? voy_.SetViewTimeBudget(view_, &budget) : voy_.SetViewTau(view_, tau_);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_SCENE_CLOSED) << voy_.message();
  }
  VoyResult draw(VoyView view, VoyTarget target, uint32_t wait) {
    VoyFrameStreaming streaming = VOY_FRAME_STREAMING_INIT;
    streaming.waitResident = wait;
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    std::copy(position_.begin(), position_.end(), eye.pose.position);
    eye.pose.orientation[1] = std::sin(yaw_ / 2);
    eye.pose.orientation[3] = std::cos(yaw_ / 2);
    eye.frustum = {-0.6, 0.6, 0.4, -0.4};
    eye.target = target;
    VoyFrame frame = VOY_FRAME_INIT;
    frame.next = &streaming;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    const VoyResult result = voy_.RenderFrame(view, &frame);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_SCENE_CLOSED ||
                (wait == 1 && result == VOY_ERROR_OVER_BUDGET && says_how_much()))
        << voy_.message();
    if (result == VOY_ERROR_SCENE_CLOSED) make_view();
    return result;
  }
  // And not that others took what had come, again and again.
  bool says_how_much() const { return voy_.message().find(" MB") != std::string::npos; }
  // What is streamed is, where the budget holds it, what is in memory as a whole, to the bit.
  void stand_still() {
    VoyResult result = voy_.SetViewTau(view_, tau_);
    EXPECT_TRUE(result == VOY_SUCCESS || result == VOY_ERROR_SCENE_CLOSED) << voy_.message();
    if (draw(view_, target_, 1) != VOY_SUCCESS) return;
    std::array<VoyScene, 2> shown{};
    for (size_t i = 0; i < count_; ++i) shown[i] = scenes_.whole(shown_[i]);
    std::vector<float> expected(pixels_.size());
    const VoyTarget target = target_of(expected);
    VoyView view = nullptr;
    ASSERT_EQ(create_view(shown, view), VOY_SUCCESS) << voy_.message();
    ASSERT_EQ(set_instances(view, shown), VOY_SUCCESS) << voy_.message();
    EXPECT_EQ(draw(view, target, 0), VOY_SUCCESS);
    EXPECT_TRUE(pixels_ == expected) << width_ << "x" << height_ << ", tau " << tau_;
    EXPECT_EQ(voy_.DestroyView(view), VOY_SUCCESS) << voy_.message();
    EXPECT_EQ(voy_.DestroyTarget(target), VOY_SUCCESS) << voy_.message();
    ++compared_;
  }

  const Library& voy_;
  VoyDevice device_;
  Scenes& scenes_;
  Dice& dice_;
  std::vector<float> pixels_;
  VoyTarget target_ = nullptr;
  VoyView view_ = nullptr;
  uint32_t width_ = 0, height_ = 0;
  size_t count_ = 0;
  std::array<size_t, 2> shown_{};  // of Scenes
  std::array<VoyInstance, 2> looks_{};
  std::array<double, 3> position_{0, 0, 12};
  double yaw_ = 0, tau_ = 1;
  int drawn_ = 0, compared_ = 0;
};

struct Done {
  std::atomic<int> drawn{0}, compared{0}, reopened{0};
};

void live(const Library& voy, VoyDevice device, Scenes& scenes, unsigned seed,
          std::chrono::steady_clock::time_point end, Done& done) {
  Dice dice(seed);
  std::vector<Viewer> viewers;
  for (int i = 0; i < kViewsOfThread; ++i) viewers.emplace_back(voy, device, scenes, dice);
  while (std::chrono::steady_clock::now() < end && !testing::Test::HasFailure()) {
    viewers[dice.below(viewers.size())].act();
    if (dice.one_in(50)) scenes.rebudget(dice.below(kGaussians.size()), dice);
    if (dice.one_in(80)) {
      scenes.reopen(dice.below(kGaussians.size()), dice);
      ++done.reopened;
    }
  }
  for (const Viewer& viewer : viewers) {
    done.drawn += viewer.drawn();
    done.compared += viewer.compared();
  }
}

// A device from its creation to its end, with views that the host forgets.
void live_a_life(const Library& voy, VoyBackend backend, unsigned seed, double seconds,
                 Done& done) {
  CountingAllocator memory;
  const VoyAllocator allocator = memory.desc();
  VoyDeviceDesc desc = device_for(backend);
  desc.allocator = &allocator;
  VoyDevice device = nullptr;
  ASSERT_EQ(voy.CreateDevice(&desc, &device), VOY_SUCCESS) << voy.message();
  {
    Scenes scenes(voy, device);
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                         std::chrono::duration<double>(seconds));
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < kThreads; ++t)
      threads.emplace_back([&, t] { live(voy, device, scenes, kThreads * seed + t, end, done); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS) << voy.message();
  }
  EXPECT_EQ(memory.bytes_out, 0);
}

ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                       std::filesystem::directory_iterator());
}

// Bytes of the heap. A sanitizer has a heap of its own, and looks for leaks itself.
size_t heap() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return 0;
#else
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
}

class Soak : public OnBackend {};

TEST_P(Soak, NothingIsLostAndNothingLeaks) {
  constexpr int kLives = 3;
  for (const int gaussians : kGaussians) ASSERT_FALSE(baked_bytes(gaussians).empty());
  const double seconds = seconds_wanted();
  Done done;
  size_t heap_before = 0;
  ptrdiff_t files_before = 0;
  for (int life = 0; life < kLives && !HasFailure(); ++life) {
    live_a_life(voy, GetParam(), static_cast<unsigned>(life + 1), seconds / kLives, done);
    // What is made once, by the library or by a driver, is there after the first.
    if (life == 0) {
      heap_before = heap();
      files_before = open_files();
    }
  }
  EXPECT_LT(heap(), heap_before + (size_t{1} << 20));
  EXPECT_LE(open_files(), files_before);
  EXPECT_GT(done.drawn, 0);
  std::cout << done.drawn << " frames, " << done.compared << " compared, " << done.reopened
            << " scenes opened again\n";
}

INSTANTIATE_TEST_SUITE_P(, Soak, ::testing::Values(VOY_BACKEND_CPU, VOY_BACKEND_CUDA),
                         backend_name);

}  // namespace
}  // namespace soak_test
