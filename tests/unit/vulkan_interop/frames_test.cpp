// Every wait has its signal: what a frame waits for and signals in each mode, frames that fail
// or are refused, and the end of a ring whose frames are in flight.
#include <chrono>

#include "tests/support/vulkan_rig.h"

namespace voyager::test {
namespace frames_test {
namespace {

using vulkan::FrameSync;
using vulkan::Sharing;
using vulkan::Sync;

const Mode& mode_of(Sharing sharing, Sync sync) {
  for (const Mode& mode : kModes)
    if (mode.sharing == sharing && mode.sync == sync) return mode;
  std::abort();
}

constexpr auto kPatience = std::chrono::milliseconds(50);

struct Rig {
  explicit Rig(Sharing sharing, Sync sync, const vulkan::RingDesc& desc = ring_desc())
      : device(make_device(mock, mode_of(sharing, sync))),
        ring(std::make_unique<vulkan::Ring>(device, desc, backend.import(),
                                            std::pmr::new_delete_resource())),
        released(ring->image(0).released),
        rendered(ring->image(0).rendered) {
    backend.patience = kPatience;
    for (uint32_t i = 0; i < desc.images; ++i)
      ring->record_release(i, {VulkanMock::commands_at(0), 0, VK_IMAGE_LAYOUT_GENERAL,
                               VK_PIPELINE_STAGE_TRANSFER_BIT});
  }

  void expect_refused(const FrameSync& sync, ErrorCode code = ErrorCode::invalid_argument) {
    EXPECT_EQ(thrown_by([&] { ring->begin_frame(0, 0, sync); }), error_of(code))
        << sync.wait_value << ", " << sync.signal_value;
  }

  VulkanMock mock;
  Backend backend{mock};
  std::shared_ptr<const vulkan::Device> device;
  std::unique_ptr<vulkan::Ring> ring;
  VkSemaphore released, rendered;
};

TEST(VulkanFrames, AHostsFrameWaitsForReleasedAndSignalsRenderedOnce) {
  Rig rig(Sharing::host, Sync::timeline);
  for (uint64_t frame = 1; frame <= 5; ++frame) {
    const FrameSync sync{2 * frame, 3 * frame};
    rig.mock.signal(rig.released, 2 * frame);
    const Image image = rig.ring->begin_frame(frame % 2, 1, sync);
    ASSERT_EQ(rig.mock.waits.size(), frame);
    EXPECT_EQ(rig.mock.waits.back().semaphore, rig.released);
    EXPECT_EQ(rig.mock.waits.back().value, sync.wait_value);
    EXPECT_EQ(rig.mock.signals.size(), frame - 1);
    EXPECT_NE(image.color, nullptr);
    EXPECT_EQ(image.external.ring, nullptr);
    rig.ring->end_frame(sync);
    ASSERT_EQ(rig.mock.signals.size(), frame);
    EXPECT_EQ(rig.mock.signals.back().semaphore, rig.rendered);
    EXPECT_EQ(rig.mock.signals.back().value, sync.signal_value);
    EXPECT_EQ(rig.mock.value(rig.rendered), sync.signal_value);
  }
}

TEST(VulkanFrames, WithoutAWaitValueNothingIsWaitedFor) {
  Rig rig(Sharing::host, Sync::timeline);
  rig.ring->begin_frame(0, 0, {0, 1});
  rig.ring->end_frame({0, 1});
  EXPECT_TRUE(rig.mock.waits.empty());
  EXPECT_EQ(rig.mock.value(rig.rendered), 1u);
}

TEST(VulkanFrames, AReleaseThatNeverComesIsATimeoutAndTheFrameCanBeTriedAgain) {
  Rig rig(Sharing::host, Sync::timeline);
  rig.mock.signal(rig.released, 4);
  rig.expect_refused({5, 1}, ErrorCode::timeout);
  EXPECT_TRUE(rig.mock.signals.empty());
  rig.mock.signal(rig.released, 5);
  rig.ring->begin_frame(0, 0, {5, 1});
  rig.ring->end_frame({5, 1});
  EXPECT_EQ(rig.mock.value(rig.rendered), 1u);
}

TEST(VulkanFrames, AFrameThatFailsSignalsNothingAndItsValuesAreStillFree) {
  Rig rig(Sharing::host, Sync::timeline);
  rig.mock.signal(rig.released, 9);
  rig.ring->begin_frame(0, 0, {1, 7});  // and the frame fails
  EXPECT_TRUE(rig.mock.signals.empty());
  rig.ring->begin_frame(0, 0, {1, 7});
  rig.ring->end_frame({1, 7});
  EXPECT_EQ(rig.mock.signals.size(), 1u);
}

TEST(VulkanFrames, AWaitOrASignalThatFailsIsTheCallsErrorAndTheFrameCanBeTriedAgain) {
  Rig rig(Sharing::host, Sync::timeline);
  rig.mock.signal(rig.released, 1);
  rig.mock.fail_at(0, VK_ERROR_DEVICE_LOST);
  rig.expect_refused({1, 1}, ErrorCode::device_lost);
  rig.mock.fail_at(0, VK_ERROR_OUT_OF_HOST_MEMORY);
  EXPECT_EQ(thrown_by([&] { rig.ring->begin_frame(0, 0, {1, 1}); }), "bad_alloc");
  rig.ring->begin_frame(0, 0, {1, 1});
  rig.mock.fail_at(0, VK_ERROR_OUT_OF_HOST_MEMORY);
  EXPECT_EQ(thrown_by([&] { rig.ring->end_frame({1, 1}); }), "bad_alloc");
  EXPECT_TRUE(rig.mock.signals.empty());
  EXPECT_EQ(thrown_by([&] { rig.ring->begin_frame(0, 0, {1, 1}); }), "");
  rig.ring->end_frame({1, 1});
  EXPECT_EQ(rig.mock.value(rig.rendered), 1u);
}

TEST(VulkanFrames, SignalValuesThatDoNotGrowAreRefusedBeforeAnythingIsWaitedFor) {
  for (const Sharing sharing : {Sharing::host, Sharing::device}) {
    Rig rig(sharing, Sync::timeline);
    rig.mock.signal(rig.released, 100);
    rig.expect_refused({1, 0});
    rig.ring->begin_frame(0, 0, {0, 5});
    rig.ring->end_frame({0, 5});
    for (const uint64_t value : {uint64_t{0}, uint64_t{4}, uint64_t{5}})
      rig.expect_refused({1, value});
    EXPECT_TRUE(rig.mock.waits.empty());
    EXPECT_EQ(rig.mock.signals.size(), sharing == Sharing::host ? 1u : 0u);
    rig.ring->begin_frame(0, 0, {1, 6});
  }
}

TEST(VulkanFrames, ValuesThatAModeDoesNotHaveAreRefused) {
  {
    Rig rig(Sharing::device, Sync::binary);
    for (const FrameSync& sync : {FrameSync{2, 1}, FrameSync{2, 0}, FrameSync{1, 2}})
      rig.expect_refused(sync);
    rig.ring->begin_frame(0, 0, {1, 1});
    rig.ring->begin_frame(0, 0, {0, 1});
  }
  for (const Sharing sharing : {Sharing::host, Sharing::device}) {
    Rig rig(sharing, Sync::host);
    for (const FrameSync& sync : {FrameSync{1, 0}, FrameSync{0, 1}}) rig.expect_refused(sync);
    rig.ring->begin_frame(0, 0, {0, 0});
    rig.ring->end_frame({0, 0});
    EXPECT_TRUE(rig.mock.waits.empty());
    EXPECT_TRUE(rig.mock.signals.empty());
  }
}

// The backend waits and signals then; nothing here does.
TEST(VulkanFrames, ADevicesFrameCarriesItsWaitAndSignal) {
  struct Case {
    Sync sync;
    FrameSync values;
    bool waits, signals;
  };
  for (const Case& c :
       {Case{Sync::timeline, {3, 9}, true, true}, Case{Sync::timeline, {0, 9}, false, true},
        Case{Sync::binary, {1, 1}, true, true}, Case{Sync::binary, {0, 1}, false, true},
        Case{Sync::host, {0, 0}, false, false}}) {
    Rig rig(Sharing::device, c.sync);
    const Image image = rig.ring->begin_frame(1, 1, c.values);
    EXPECT_NE(image.external.ring, nullptr);
    EXPECT_EQ(image.external.slot, 1u);
    EXPECT_EQ(image.external.layer, 1u);
    EXPECT_EQ(image.external.waits, c.waits);
    EXPECT_EQ(image.external.signals, c.signals);
    EXPECT_EQ(image.external.wait_value, c.values.wait_value);
    EXPECT_EQ(image.external.signal_value, c.values.signal_value);
    EXPECT_EQ(image.color, nullptr);
    EXPECT_EQ(image.depth, nullptr);
    rig.ring->end_frame(c.values);
    EXPECT_TRUE(rig.mock.waits.empty());
    EXPECT_TRUE(rig.mock.signals.empty());
  }
}

TEST(VulkanFrames, TheBackendGetsTheRingsSemaphoresOnce) {
  for (const Sync sync : {Sync::timeline, Sync::binary, Sync::host}) {
    Rig rig(Sharing::device, sync);
    // Colour, depth and depth limit of two images.
    const size_t pairs = sync == Sync::timeline ? 1 : sync == Sync::binary ? 2 : 0;
    EXPECT_EQ(rig.backend.identities.size(), 6 + 2 * pairs);
    EXPECT_EQ(
        std::set<FileIdentity>(rig.backend.identities.begin(), rig.backend.identities.end()).size(),
        rig.backend.identities.size());
    EXPECT_EQ(rig.backend.got.sync, sync == Sync::timeline ? ExternalSync::timeline
                                    : sync == Sync::binary ? ExternalSync::binary
                                                           : ExternalSync::none);
    const bool same = rig.ring->image(0).released == rig.ring->image(1).released;
    EXPECT_EQ(same, sync != Sync::binary);
    EXPECT_EQ(rig.released == VK_NULL_HANDLE, sync == Sync::host);
  }
}

TEST(VulkanFrames, ARingOfFramesUnderWayEndsOnceTheyAreDone) {
  for (const Sync sync : {Sync::timeline, Sync::binary, Sync::host}) {
    Rig rig(Sharing::device, sync);
    int asked = 0;
    rig.backend.idle = [&] {
      EXPECT_TRUE(rig.mock.has(rig.ring->image(0).color)) << "destroyed before the frames' end";
      return ++asked > 20;
    };
    rig.ring->finish();
    EXPECT_EQ(asked, 21);
    rig.backend.idle = [&] { return true; };
    rig.ring.reset();
    EXPECT_TRUE(rig.mock.signals.empty());
    EXPECT_EQ(rig.mock.live(), 0u) << rig.mock.live_kinds();
  }
}

// The frame waits for a release that the host will never submit: without help it never ends.
TEST(VulkanFrames, AReleaseThatTheHostLeftIsSignalledAtTheEndAfterAWhile) {
  Rig rig(Sharing::device, Sync::timeline);
  rig.ring->begin_frame(0, 0, {3, 1});
  rig.ring->end_frame({3, 1});
  rig.ring->begin_frame(1, 0, {2, 2});
  rig.ring->end_frame({2, 2});
  rig.backend.idle = [&] {
    return !rig.mock.has(rig.released) || rig.mock.value(rig.released) >= 3;
  };
  const auto begin = std::chrono::steady_clock::now();
  rig.mock.fail_at(1, VK_ERROR_OUT_OF_HOST_MEMORY);  // which is tried again
  rig.ring.reset();
  EXPECT_TRUE(rig.mock.failed());
  EXPECT_GT(std::chrono::steady_clock::now() - begin, kPatience);
  ASSERT_EQ(rig.mock.signals.size(), 1u);
  EXPECT_EQ(rig.mock.signals[0].semaphore, rig.released);
  EXPECT_EQ(rig.mock.signals[0].value, 3u);
  EXPECT_EQ(rig.mock.live(), 0u) << rig.mock.live_kinds();
}

TEST(VulkanFrames, WithoutSemaphoresTheCallWaitsForItsFrame) {
  for (const Sync sync : {Sync::timeline, Sync::binary, Sync::host}) {
    Rig rig(Sharing::device, sync);
    const uint64_t signal = sync == Sync::host ? 0 : 1;
    rig.ring->begin_frame(0, 0, {0, signal});
    rig.ring->end_frame({0, signal});
    EXPECT_EQ(rig.backend.waits, sync == Sync::host ? 1 : 0);
  }
}

// A lost device, say: nobody hangs.
TEST(VulkanFrames, FramesThatNeverEndAreGivenUp) {
  for (const Sync sync : {Sync::timeline, Sync::binary, Sync::host}) {
    Rig rig(Sharing::device, sync);
    rig.backend.idle = [] { return false; };
    EXPECT_FALSE(rig.ring->finish());
    rig.backend.idle = [] { return true; };
    EXPECT_TRUE(rig.ring->finish());
  }
}

// Slow frames are no reason to signal what the host has signalled: a timeline must grow.
TEST(VulkanFrames, AReleaseThatCameIsNotSignalledAgain) {
  for (const uint64_t reached : {uint64_t{0}, uint64_t{3}, uint64_t{8}}) {
    Rig rig(Sharing::device, Sync::timeline);
    const uint64_t waited = reached == 0 ? 0 : 3;
    rig.ring->begin_frame(0, 0, {waited, 1});
    rig.ring->end_frame({waited, 1});
    rig.mock.signal(rig.released, reached);
    const auto end = std::chrono::steady_clock::now() + 2 * kPatience;
    rig.backend.idle = [&] { return std::chrono::steady_clock::now() > end; };
    rig.ring.reset();
    EXPECT_TRUE(rig.mock.signals.empty());
  }
}

}  // namespace
}  // namespace frames_test
}  // namespace voyager::test
