// --half-rate: Voyager draws every second frame, and those between are made of the one before.
#include "tests/vulkan_host/host_run.h"

namespace voyager::test {
namespace half_rate_test {
namespace {

constexpr int kFrames = 6;

// Six cameras of one size, each half a metre to the side of the one before.
void write_walk(const std::string& from, const std::string& to) {
  std::ifstream source(from);
  const nlohmann::json first = nlohmann::json::parse(source).front();
  nlohmann::json walk = nlohmann::json::array();
  for (int i = 0; i < kFrames; ++i) {
    walk.push_back(first);
    for (int axis = 0; axis < 3; ++axis)
      walk[static_cast<size_t>(i)]["position"][static_cast<size_t>(axis)] =
          first["position"][static_cast<size_t>(axis)].get<double>() +
          0.5 * i * first["rotation"][static_cast<size_t>(axis)][0].get<double>();
  }
  std::ofstream(to) << walk;
}

double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (size_t i = 0; i < a.values.size(); ++i)
    sum += std::abs(double{a.values[i]} - double{b.values[i]});
  return sum / static_cast<double>(a.values.size());
}

TEST_F(VulkanHost, AtHalfTheRateFramesBetweenAreCloserThanTheFrameBefore) {
  write_walk(file("steady.json"), file("walk.json"));
  for (const std::string modes : {"--no-mesh", "--no-mesh --sync host", "--composite test"}) {
    const std::string common = "--frames " + std::to_string(kFrames) + " " + modes + " -o ";
    expect_success(host(common + file("full"), "walk.json"));
    expect_success(
        host("--half-rate --stats " + file("half_stats.json") + " " + common + file("half"),
             "walk.json"));
    for (int i = 0; i < kFrames; ++i) {
      const Picture full = read_png(numbered("full", i, "png")),
                    half = read_png(numbered("half", i, "png"));
      ASSERT_EQ(full.values.size(), half.values.size());
      if (i % 2 == 0) {
        EXPECT_EQ(largest_difference(full, half), 0) << modes << ", frame " << i;
        continue;
      }
      const double as_it_is = mean_difference(full, read_png(numbered("full", i - 1, "png")));
      EXPECT_LT(mean_difference(full, half), 0.6 * as_it_is) << modes << ", frame " << i;
    }
    std::ifstream stats(file("half_stats.json"));
    EXPECT_EQ(nlohmann::json::parse(stats)["frames"].back()["frame"].get<int>(), kFrames / 2 - 1);
  }
}

// Images that are new hold nothing that could be shown again.
TEST_F(VulkanHost, AtHalfTheRateAFrameOfAnotherSizeIsDrawn) {
  for (const std::string rate : {"", "--half-rate "})
    expect_success(host(rate + "--frames 6 -o " + file(rate.empty() ? "full" : "half")));
  for (int i = 0; i < kFrames; ++i)
    EXPECT_EQ(largest_difference(read_png(numbered("full", i, "png")),
                                 read_png(numbered("half", i, "png"))),
              0);
}

}  // namespace
}  // namespace half_rate_test
}  // namespace voyager::test
