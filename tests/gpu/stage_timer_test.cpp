// What a stage's time is of: its own work, and no wait of the host's.
#include "cuda/device/stage_timer.h"
#include "cuda/device/head_start.h"
#include "tests/gpu/device_test.h"

namespace voyager::test {
namespace stage_timer_test {
namespace {

class StageTimerTest : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    if (!IsSkipped()) stream = std::make_unique<cuda::Stream>();
  }
  void work(double milliseconds) const {
    cuda::give_head_start(stream->get(), static_cast<unsigned long long>(milliseconds * 1e6));
  }
  FrameStats collected(const cuda::StageTimer& timer) const {
    stream->wait();
    FrameStats stats;
    timer.collect(stats);
    return stats;
  }

  std::unique_ptr<cuda::Stream> stream;
};

TEST_F(StageTimerTest, WhatIsLeftOutIsInNoTime) {
  cuda::StageTimer timer(*stream);
  timer.begin();
  work(6);
  timer.end(kSearch);
  work(80);
  timer.leave_out();
  work(4);
  timer.end(kProject);
  const FrameStats stats = collected(timer);
  EXPECT_GT(stats.milliseconds[kSearch], 4.5);
  EXPECT_GT(stats.milliseconds[kProject], 2.5);
  EXPECT_LT(stats.milliseconds[kProject], 40);
  EXPECT_GT(stats.total_milliseconds, 7);
  EXPECT_LT(stats.total_milliseconds, 60);
}

TEST_F(StageTimerTest, TheNextFrameLeavesNothingOut) {
  cuda::StageTimer timer(*stream);
  timer.begin();
  timer.leave_out();
  timer.end(kSearch);
  timer.begin();
  timer.end(kSearch);
  work(20);
  timer.end(kProject);
  const FrameStats stats = collected(timer);
  EXPECT_GT(stats.milliseconds[kProject], 17);
  EXPECT_GT(stats.total_milliseconds, 17);
}

TEST_F(StageTimerTest, WhatIsDoneAgainHasTheTimeOfBoth) {
  cuda::StageTimer timer(*stream);
  work(5);  // the marks are recorded meanwhile
  timer.begin();
  timer.end(kSearch);
  work(10);
  timer.end(kProject);
  timer.go_back_to(kSearch);
  work(10);
  timer.end(kProject);
  const FrameStats stats = collected(timer);
  EXPECT_GT(stats.milliseconds[kProject], 17);
  EXPECT_LT(stats.milliseconds[kSearch], 5);
}

}  // namespace
}  // namespace stage_timer_test
}  // namespace voyager::test
