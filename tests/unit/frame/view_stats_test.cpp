// What a view says of frames that end by themselves, in another API's images.
#include <gtest/gtest.h>

#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/view.h"

namespace voyager {
namespace view_stats_test {
namespace {

class Ring final : public ExternalRing {
 public:
  bool idle() const override { return true; }
  void wait() const override {}
};

// Frames that drop so many pairs, and end when they are let go.
struct Script {
  std::vector<uint64_t> dropped;
  size_t let_go = 0;
};

class ScriptedPipeline final : public Pipeline {
 public:
  explicit ScriptedPipeline(Script& script) : script_(script) {}
  void set_scenes(const Scenes&, std::span<const size_t>) override {}
  void draw(const FrameInput&, FrameStats&) override {}
  void resolve(const FrameInput&, FrameStats&) override {}
  void submit(const FrameInput&, bool) override { ++submitted_; }
  bool finish(bool wait, FrameStats& stats) override {
    if (finished_ == submitted_ || (!wait && finished_ >= script_.let_go)) return false;
    stats.pairs_dropped = script_.dropped[finished_++];
    return true;
  }
  bool counts_changes() const override { return true; }
  void read_cut(size_t, std::pmr::vector<uint32_t>&) const override {}
  bool cut_is_near() const override { return false; }

 private:
  Script& script_;
  size_t submitted_ = 0, finished_ = 0;
};

class ScriptedBackend final : public Backend {
 public:
  explicit ScriptedBackend(Script& script) : script_(script) {}
  std::string device_name() const override { return "script"; }
  std::unique_ptr<Pipeline> create_pipeline(const Scenes&, const PipelineDesc&,
                                            std::pmr::memory_resource*, Workers&) override {
    return std::make_unique<ScriptedPipeline>(script_);
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene>, const SearchDesc&,
                                             std::pmr::memory_resource*, Workers&) override {
    return nullptr;
  }

 private:
  Script& script_;
};

TEST(ViewStats, AFrameThatWasIncompleteIsNotForgottenBeforeItWasToldOf) {
  Script script{{5, 0, 7, 0, 0}, 0};
  ScriptedBackend backend(script);
  Workers workers(1);
  View view(Scenes{}, backend, PipelineDesc{}, std::pmr::get_default_resource(), workers);
  Ring ring;
  FrameInput frame;
  frame.eyes[0].image.external.ring = &ring;
  for (size_t i = 0; i < script.dropped.size(); ++i) view.render(frame);
  script.let_go = 2;  // the one that dropped, and the one behind it
  EXPECT_EQ(view.stats().frame_index, 1u);
  EXPECT_EQ(view.stats().pairs_dropped, 5u);
  script.let_go = 4;
  EXPECT_EQ(view.stats().frame_index, 3u);
  EXPECT_EQ(view.stats().pairs_dropped, 7u);
  script.let_go = 5;
  EXPECT_EQ(view.stats().pairs_dropped, 0u);
}

}  // namespace
}  // namespace view_stats_test
}  // namespace voyager
