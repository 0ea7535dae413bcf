// Energy a frame, and the sensors that know of it.
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "tests/support/test_support.h"
#include "tools/report/frame_energy.h"

namespace voyager::tools {
namespace energy_test {
namespace {

class FakeMeter final : public EnergyMeter {
 public:
  std::optional<double> joules() override { return value; }
  const std::string& name() const override { return name_; }

  std::optional<double> value = 0;

 private:
  const std::string name_ = "fake";
};

TEST(FrameEnergy, IsOfTimedFramesAlone) {
  FakeMeter meter;
  FrameEnergy energy(&meter, 3, 0);
  for (size_t drawn = 1; drawn <= 7; ++drawn) {
    meter.value = drawn <= 3 ? 100.0 * static_cast<double>(drawn) : 300.0 + 8;
    energy.frame(drawn);
  }
  EXPECT_EQ(energy.joules_a_frame(), 2);  // of four
  EXPECT_FALSE(energy.wants_more());
}

// However fast frames are: as many are asked for as the sensor needs.
TEST(FrameEnergy, WantsFramesUntilTheSensorHasSeenEnough) {
  FakeMeter meter;
  const Stopwatch watch;
  FrameEnergy energy(&meter, 1, 300);
  energy.frame(1);
  energy.frame(2);
  EXPECT_TRUE(energy.wants_more());
  EXPECT_EQ(energy.joules_a_frame(), std::nullopt);
  size_t drawn = 2;
  while (energy.wants_more()) {
    energy.frame(++drawn);
    meter.value = 5.0 * static_cast<double>(drawn - 1);
  }
  EXPECT_GE(watch.milliseconds(), 300);
  EXPECT_EQ(energy.joules_a_frame(), 5);
}

TEST(FrameEnergy, WithoutASensorThatAnswersIsNoneAndWantsNothing) {
  FrameEnergy none(nullptr, 0, 0);
  none.frame(0);
  none.frame(1);
  EXPECT_FALSE(none.wants_more());
  EXPECT_EQ(none.joules_a_frame(), std::nullopt);
  FakeMeter meter;
  meter.value.reset();
  FrameEnergy silent(&meter, 1, 1e9);
  silent.frame(1);
  silent.frame(2);
  EXPECT_FALSE(silent.wants_more());
  EXPECT_EQ(silent.joules_a_frame(), std::nullopt);
}

TEST(EnergyMeter, OfACpuIsNone) {
  EXPECT_EQ(find_energy_meter({}), nullptr);
}

TEST(EnergyMeter, UuidsAreWrittenAsNvmlWritesThem) {
  std::array<uint8_t, 16> uuid{};
  for (size_t i = 0; i < uuid.size(); ++i) uuid[i] = static_cast<uint8_t>(17 * i);
  EXPECT_EQ(nvml_uuid(uuid), "GPU-00112233-4455-6677-8899-aabbccddeeff");
}

TEST(EnergyMeter, ARailsPowerIsSummedOverTime) {
  const test::TempFolder folder;
  EXPECT_EQ(find_gpu_rail(folder.file("")), nullptr);
  std::filesystem::create_directories(folder.file("hwmon0"));
  for (const auto& [name, text] : {std::pair{"in1_label", "VDD_CPU_CV"},
                                   {"in1_input", "9000"},
                                   {"curr1_input", "9000"},
                                   {"in2_label", "VDD_GPU_SOC"},
                                   {"in2_input", "5000"},
                                   {"curr2_input", "2000"}})
    std::ofstream(folder.file(std::string("hwmon0/") + name)) << text << "\n";
  const Stopwatch watch;
  const auto rail = find_gpu_rail(folder.file(""));
  ASSERT_NE(rail, nullptr);
  EXPECT_EQ(rail->name(), "VDD_GPU_SOC");
  while (rail->joules().value_or(0) == 0 && watch.milliseconds() < 10000)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const double joules = rail->joules().value_or(0);
  EXPECT_GT(joules, 0);
  EXPECT_LE(joules, 10 * watch.milliseconds() / 1000);  // 10 W
}

}  // namespace
}  // namespace energy_test
}  // namespace voyager::tools
