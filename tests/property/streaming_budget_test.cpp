// A budget holds for all that a scene and its views keep, at every moment: while views come, draw
// and go, and while the budget changes.
#include <gtest/gtest.h>

#include <list>
#include <random>

#include "runtime/frame/open_streamed.h"
#include "runtime/frame/whole_tree.h"
#include "runtime/stream/linker.h"
#include "tests/support/counting_memory.h"
#include "tests/support/is_cut.h"
#include "tests/support/random_trees.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::streaming_budget_test {
namespace {

const test::Bytes& scene_bytes() {
  static const test::Bytes bytes = [] {
    GaussianCloud cloud = test::random_cloud(4000, 3, 1);
    for (float& x : cloud.position) x *= 20;
    return test::scene_bytes(test::bake(cloud), Quality::compact, 0, kMinChunkBytes);
  }();
  return bytes;
}

// What a frame takes for itself comes from elsewhere, and is not counted.
struct Rig {
  explicit Rig(double share) : file(test::source_of(scene_bytes())) {
    StreamingDesc desc;
    desc.readers = 0;
    desc.first_bytes = 0;
    desc.clock = [this] { return time += 1e-5; };
    desc.count = [this](uint64_t now) { counted = now; };
    shape = SceneStream::slot_shape(file);
    whole = load_scene(test::source_of(scene_bytes()), std::pmr::get_default_resource(), workers);
    bytes = backend->room_bytes(*whole, shape);
    desc.budget = budget = bytes.of(room(share));
    scene = open_streamed(test::source_of(scene_bytes()), desc, *backend, &memory, workers);
  }

  PoolRoom room(double share) const {
    const auto chunks = static_cast<double>(file.chunks().size());
    return RecordRoom(file).of(
        std::max(SceneStream::top_chunks(file), static_cast<uint32_t>(share * chunks)));
  }
  void set_budget(uint64_t now) {
    scene->stream->set_budget(now, workers);
    budget = now;
  }
  std::unique_ptr<View> make_view(const Scenes& scenes) {
    return std::make_unique<View>(scenes, *backend, PipelineDesc{},
                                  std::pmr::get_default_resource(), workers);
  }
  std::unique_ptr<View> make_view() { return make_view({scene}); }
  // A frame, and chunks that come for it.
  void draw(View& view, const Vec3d& eye) {
    const auto input = test::frame_input(test::look(eye, {0, 0, 0}, 16, 12, 60), 1);
    for (int i = 0; i < 3; ++i) {
      const test::Frame frame = test::render(view, input);
      ASSERT_TRUE(test::is_cut(*whole_tree(*whole), frame.cut));
      for (int steps = 0; steps < 40 && scene->stream->step(); ++steps) continue;
    }
  }
  // What was allocated since the last call, with what may link as many chunks as there is room for.
  void expect_kept(uint64_t most) {
    const PoolRoom now = RecordRoom(file).of(scene->stream->counters().slots);
    const uint64_t links = Linker::bytes(shape).of(now);
    EXPECT_LE(memory.most() + links, most);
    EXPECT_LE(memory.used() + links, counted);
    EXPECT_LE(counted, budget);
    EXPECT_EQ(counted, scene->stream->bytes());
    memory.start_again();
  }

  double time = 0;
  test::CountingMemory memory;
  Workers workers{1};
  const SceneFile file;
  SlotShape shape{};
  RoomBytes bytes{};
  uint64_t budget = 0, counted = 0;
  const std::unique_ptr<Backend> backend = create_cpu_backend();
  std::shared_ptr<const Scene> whole;
  std::shared_ptr<Scene> scene;
};

Vec3d somewhere(std::mt19937& random) {
  return {80.0 * test::unit(random) - 40, -5, 80.0 * test::unit(random) - 40};
}

TEST(StreamingBudget, HoldsWhileViewsComeAndGoAndItChanges) {
  Rig rig(0.6);
  std::list<std::unique_ptr<View>> views;
  std::mt19937 random(4);
  rig.expect_kept(rig.budget);
  size_t drawn = 0, refused = 0, most_views = 0;
  const auto try_to = [&](const auto& change) {
    try {
      change();
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::over_budget) << error.what();
      ++refused;
    }
  };
  for (int i = 0; i < 120 && !testing::Test::HasFatalFailure(); ++i) {
    const uint64_t before = rig.budget;
    switch (random() % 5) {
      case 0:
        if (views.size() < 5) try_to([&] { views.push_back(rig.make_view()); });
        break;
      case 1:
        if (views.size() > 1) views.pop_front();
        break;
      case 2:
        if (!views.empty())
          try_to([&] { views.front()->set_scenes(Scenes(1 + random() % 3, rig.scene)); });
        break;
      case 3:
        try_to(
            [&] { rig.set_budget(rig.bytes.of(rig.room(0.7 * double{test::unit(random)}), 3)); });
        break;
      default:
        for (const auto& view : views)
          if (view->instances() == 1) rig.draw(*view, somewhere(random)), ++drawn;
    }
    most_views = std::max(most_views, views.size());
    rig.expect_kept(std::max(before, rig.budget));
  }
  EXPECT_GT(drawn, 20u);
  EXPECT_GT(refused, 0u);
  EXPECT_GT(most_views, 2u);
  views.clear();
  rig.expect_kept(rig.budget);
}

// So that the first view of a scene drops nothing.
TEST(StreamingBudget, HasRoomForAFirstView) {
  Rig rig(0.5);
  const uint32_t slots = rig.scene->stream->counters().slots;
  const auto first = rig.make_view();
  EXPECT_EQ(rig.scene->stream->counters().slots, slots);
  const auto second = rig.make_view();
  EXPECT_LT(rig.scene->stream->counters().slots, slots);
}

TEST(StreamingBudget, AViewWithoutRoomIsRefusedWithWhatItTakesAndComesOnceThatIsThere) {
  Rig rig(0);
  const auto first = rig.make_view();
  rig.draw(*first, {0, -5, -40});
  std::string message;
  try {
    rig.make_view();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::over_budget);
    message = error.what();
  }
  const size_t takes = message.find("takes ");
  ASSERT_NE(takes, std::string::npos) << message;
  rig.draw(*first, {0, -5, 40});
  const auto enough = static_cast<uint64_t>(1e6 * std::stod(message.substr(takes + 6)) + 1000);
  EXPECT_LT(enough, rig.bytes.of(rig.room(0), 3));
  rig.set_budget(enough);
  const auto second = rig.make_view();
  rig.draw(*first, {0, -5, -40});
  rig.draw(*second, {0, -5, 40});
  rig.expect_kept(enough);
}

// A device's budget that others have taken.
TEST(StreamingBudget, ACountThatIsRefusedChangesNothing) {
  Rig rig(0.5);
  const auto first = rig.make_view();
  const uint64_t before = rig.scene->stream->bytes();
  StreamingDesc desc;
  desc.readers = 0;
  uint64_t counted = 0;
  desc.count = [&](uint64_t bytes) {
    if (bytes > before + 1000) throw Error(ErrorCode::over_budget, "others have it");
    counted = bytes;
  };
  desc.budget = before;
  const auto scene =
      open_streamed(test::source_of(scene_bytes()), desc, *rig.backend, &rig.memory, rig.workers);
  EXPECT_EQ(test::error_code([&] { scene->stream->set_budget(0, rig.workers); }),
            ErrorCode::over_budget);
  EXPECT_EQ(counted, scene->stream->bytes());
  const auto view = rig.make_view({scene});
  rig.draw(*view, {0, -5, -40});
  EXPECT_LE(scene->stream->bytes(), before);
}

// The budget has more than that, but other scenes took it since.
TEST(StreamingBudget, AViewThatFindsNothingLeftTakesItFromChunks) {
  Rig rig(0);
  StreamingDesc desc;
  desc.readers = 0;
  uint64_t left = UINT64_MAX;
  desc.count = [&](uint64_t bytes) {
    if (bytes > left) throw Error(ErrorCode::over_budget, "others have it");
  };
  desc.budget = rig.bytes.of(rig.room(0.5));
  const auto scene =
      open_streamed(test::source_of(scene_bytes()), desc, *rig.backend, &rig.memory, rig.workers);
  SceneStream& stream = *scene->stream;
  stream.set_budget(2 * desc.budget, rig.workers);
  stream.resize(rig.room(0.5), 1, rig.workers);
  left = stream.bytes();
  const auto first = rig.make_view({scene}), second = rig.make_view({scene});
  EXPECT_LE(stream.bytes(), left);
  EXPECT_LT(stream.counters().slots, rig.room(0.5).slots);
  rig.draw(*second, {0, -5, -40});
}

}  // namespace
}  // namespace voyager::streaming_budget_test
