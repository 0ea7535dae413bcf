// How a configuration is measured: which frames count, which are compared.
#include <gtest/gtest.h>

#include <fstream>

#include "runtime/cpu/cpu_backend.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"
#include "tools/report/measure.h"

namespace voyager::tools {
namespace measure_test {
namespace {

struct Drawn {
  double tau;
  bool seen;  // by somebody: its image was asked for
};

// Frames as they are, and the times that a test gives them.
struct Script {
  std::function<double(size_t)> milliseconds;  // of the frame with this index
  std::vector<Drawn> drawn;
};

class ScriptedPipeline final : public Pipeline {
 public:
  ScriptedPipeline(std::unique_ptr<Pipeline> inner, Script& script)
      : inner_(std::move(inner)), script_(script) {}
  void set_scenes(const Scenes& scenes, std::span<const size_t> from) override {
    inner_->set_scenes(scenes, from);
  }
  void draw(const FrameInput& frame, FrameStats& stats) override { inner_->draw(frame, stats); }
  void resolve(const FrameInput& frame, FrameStats& stats) override {
    inner_->resolve(frame, stats);
    const double time = script_.milliseconds(script_.drawn.size());
    std::fill_n(stats.milliseconds, int{kStageCount}, 0.0);
    stats.milliseconds[kRasterize] = stats.total_milliseconds = time;
    script_.drawn.push_back({frame.tau, frame.eyes[0].image.color != nullptr});
  }
  bool counts_changes() const override { return inner_->counts_changes(); }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    inner_->read_cut(instance, cut);
  }
  bool cut_is_near() const override { return inner_->cut_is_near(); }

 private:
  std::unique_ptr<Pipeline> inner_;
  Script& script_;
};

class ScriptedBackend final : public Backend {
 public:
  std::string device_name() const override { return "script"; }
  std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                            std::pmr::memory_resource* memory,
                                            Workers& workers) override {
    return std::make_unique<ScriptedPipeline>(
        inner_->create_pipeline(scenes, desc, memory, workers), script);
  }
  std::unique_ptr<ChunkPool> create_pool(Scene& scene, const std::shared_ptr<const SceneFile>& file,
                                         SlotShape shape, PoolRoom room) override {
    return inner_->create_pool(scene, file, shape, room);
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc,
                                             std::pmr::memory_resource* memory,
                                             Workers& workers) override {
    return inner_->create_search(std::move(scene), desc, memory, workers);
  }

  Script script;

 private:
  std::unique_ptr<Backend> inner_ = create_cpu_backend();
};

class CountingMeter final : public EnergyMeter {
 public:
  explicit CountingMeter(const Script& script) : script_(script) {}
  std::optional<double> joules() override { return 2 * static_cast<double>(script_.drawn.size()); }
  const std::string& name() const override { return name_; }

 private:
  const Script& script_;
  const std::string name_ = "two joules a frame";
};

// Three frames, thirteen times: 4 to start, 33 to settle under a budget, 39 that are timed.
class ReportMeasure : public ::testing::Test {
 protected:
  ReportMeasure() {
    const auto bytes = test::scene_bytes(test::bake(test::random_cloud(300, 5)), Quality::lossless);
    std::ofstream(folder_.file("scene.voy"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    plan_.path.assign(3, test::frame_input(test::look({0, 0, -30}, {0, 0, 0}, 24, 24)));
    plan_.repeats = 13;
    plan_.compared = {0, 2};
  }

  ReportRow measure(double time_budget, EnergyMeter* meter = nullptr) {
    ReportScenes scenes(folder_.file("scene.voy"), folder_.file(""), workers_, progress_);
    ReferenceImages references(scenes.own(), plan_.path, plan_.compared, folder_.file(""),
                               workers_);
    TruthImages truth({backend_, scenes.own(), workers_}, plan_.path, plan_.compared,
                      folder_.file(""), 0);
    const SlowPaths still;
    Measurement measurement(backend_, scenes, references, truth, still, truth, plan_, meter,
                            workers_);
    ReportCase is;
    is.time_budget = time_budget;
    is.storage = Storage::lossless;
    is.sh_degree = scenes.own()->sh_degree;
    return measurement.run(is, [](size_t) {});
  }

  const test::TempFolder folder_;
  Workers workers_;
  const Progress progress_ = [](const char*, uint64_t, uint64_t) {};
  ReportPlan plan_;
  ScriptedBackend backend_;
};

TEST_F(ReportMeasure, WithoutItsBandsASceneIsThatOfALowerDegree) {
  ReportScenes scenes(folder_.file("scene.voy"), folder_.file(""), workers_, progress_);
  const Scene& whole = *scenes.own();
  const auto lower = scenes.get(Storage::lossless, 0);
  ASSERT_EQ(whole.sh_degree, 1);
  EXPECT_EQ(lower->sh_degree, 0);
  ASSERT_EQ(lower->sh.size() * 4, whole.sh.size());
  for (uint32_t i = 0; i < lower->sh.size() / 3; ++i)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(lower->sh[3 * i + k], whole.sh[12 * i + k]);
}

// τ starts far from its place: what it takes to get there is no part of the figures.
TEST_F(ReportMeasure, ABudgetIsTimedOnceItHasSettled) {
  backend_.script.milliseconds = [](size_t frame) { return frame < 24 ? 100 : 0.9; };
  const ReportRow row = measure(1);
  EXPECT_EQ(row.timed, 39u);
  EXPECT_EQ(row.frame.p99, 0.9);
  EXPECT_GT(row.tau, 3);
}

// Not with a τ that fits them all: with that which each had when it was drawn last.
TEST_F(ReportMeasure, ComparedFramesAreDrawnAtTheTauThatTheyHad) {
  constexpr size_t kFrames = 4 + 33 + 39;
  backend_.script.milliseconds = [](size_t frame) { return frame < kFrames - 7 ? 0.9 : 9; };
  const ReportRow row = measure(1);
  const std::vector<Drawn>& drawn = backend_.script.drawn;
  ASSERT_EQ(drawn.size(), kFrames + 2 + plan_.compared.size());  // the truth is drawn last
  EXPECT_NE(drawn[kFrames - 3].tau, row.tau);
  for (const auto& [image, frame] : {std::pair{kFrames, kFrames - 3}, {kFrames + 1, kFrames - 1}}) {
    EXPECT_TRUE(drawn[image].seen);
    EXPECT_EQ(drawn[image].tau, drawn[frame].tau);
  }
  EXPECT_GT(row.same.psnr, 60);
}

TEST_F(ReportMeasure, EnergyIsOfTheTimedFramesAndAsManyMoreAsTheSensorNeeds) {
  backend_.script.milliseconds = [](size_t) { return 1; };
  CountingMeter meter(backend_.script);
  const ReportRow row = measure(0, &meter);
  EXPECT_EQ(row.joules, 2);
  EXPECT_EQ(row.timed, 39u);
  EXPECT_EQ(row.frame.p99, 1);
  EXPECT_GT(backend_.script.drawn.size(), 4u + 39 + 3);
  EXPECT_EQ(measure(0).joules, std::nullopt);
}

TEST(ReportScenes, OtherStorageIsOfTheSameTree) {
  const test::TempFolder folder;
  Workers workers;
  const auto nodes = [&](Storage storage, const TreeRule& rule) {
    const auto bytes =
        test::scene_bytes(test::bake(test::random_cloud(300, 5), rule), Quality::lossless);
    const std::string path = folder.file(rule.kind == TreeKind::clustered ? "c.voy" : "h.voy");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    std::filesystem::remove(folder.file("compact.voy"));
    ReportScenes scenes(path, folder.file(""), workers, {});
    return scenes.get(storage, scenes.own()->sh_degree)->node_count;
  };
  for (const TreeRule& rule : {TreeRule{}, test::kHierarchicalGs})
    EXPECT_EQ(nodes(Storage::compact, rule), nodes(Storage::lossless, rule));
  EXPECT_NE(nodes(Storage::compact, {}), nodes(Storage::compact, test::kHierarchicalGs));
}

}  // namespace
}  // namespace measure_test
}  // namespace voyager::tools
