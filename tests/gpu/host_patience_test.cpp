// Calls that wait for frames in flight, which a host does not let go on.
#include <functional>
#include <thread>

#include "runtime/base/error.h"
#include "tests/gpu/frames_in_flight.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_clouds.h"

namespace voyager::test {
namespace host_patience_test {
namespace {

constexpr double kPatience = 1000.0 * static_cast<double>(kHostPatience.count());  // ms

class HostPatience : public FramesInFlight {
 protected:
  static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }
  std::shared_ptr<const Scene> resident() {
    return load_scene(source_of(bytes), memory(), workers);
  }
  std::shared_ptr<Scene> streamed() {
    return open_streamed(source_of(bytes), {}, *cuda, memory(), workers);
  }

  const Bytes bytes =
      scene_bytes(bake(random_cloud(5000, 6, 0)), Quality::lossless, 0, kMinChunkBytes);
};

struct Waiting {
  const char* name;
  std::unique_ptr<View> view;  // which has a frame in flight
  std::function<void()> call;
  ErrorCode found = ErrorCode::internal;
};

// All at once, for each takes ten seconds.
void expect_timeouts(std::vector<Waiting>& all) {
  std::vector<std::thread> hosts;
  for (Waiting& waiting : all)
    hosts.emplace_back([&waiting] {
      try {
        waiting.call();
      } catch (const Error& error) {
        waiting.found = error.code();
      }
    });
  for (std::thread& host : hosts) host.join();
  for (const Waiting& waiting : all) EXPECT_EQ(waiting.found, ErrorCode::timeout) << waiting.name;
}

TEST_F(HostPatience, EndsAndWhatWasAskedForCanBeAskedForAgain) {
  const Camera small = look({3, -6, -24}, {0, 0, 2}, 64, 40),
               large = look({3, -6, -24}, {0, 0, 2}, 640, 400);
  const auto ring = make_ring(small.width, small.height);
  const auto wide = make_ring(large.width, large.height);
  const auto whole = resident();
  const std::shared_ptr<Scene> part = streamed();
  std::vector<Waiting> all(7);
  auto add = [&, next = 0](const char* name, const Scenes& scenes, auto call) mutable {
    Waiting& waiting = all[static_cast<size_t>(next++)];
    waiting.name = name;
    waiting.view = std::make_unique<View>(scenes, *cuda, PipelineDesc{}, memory(), workers);
    waiting.call = [&waiting, call] { call(*waiting.view); };
  };
  add("the cut", {whole}, [](View& of) { of.cut(0); });
  add("a frame in host memory", {whole}, [&](View& of) { render(of, frame_input(small, 3)); });
  add("other scenes", {whole}, [](View& of) { of.set_scenes({}); });
  add("a larger frame", {whole}, [&](View& of) { of.render(into(*wide, large)); });
  add("a scene's budget", {part},
      [&](View&) { part->stream->set_budget(uint64_t{8} << 20, workers); });
  add("more launches than a stream takes", Scenes(kMaxInstances, whole),
      [&](View& of) { of.render(into(*ring, small)); });
  add("a third frame of twelve instances", Scenes(12, whole), [&](View& of) {
    for (int i = 0; i < 2; ++i) of.render(into(*ring, small));
  });
  for (int i = 0; i < 3; ++i) {  // after which none frees a buffer
    for (Waiting& waiting : all) waiting.view->render(into(*ring, small));
    ring->wait();
  }
  hold_back(*ring, kPatience + 1500);
  for (Waiting& waiting : all) waiting.view->render(into(*ring, small));
  expect_timeouts(all);
  ring->wait();
  for (Waiting& waiting : all) EXPECT_NO_THROW(waiting.call()) << waiting.name;
}

}  // namespace
}  // namespace host_patience_test
}  // namespace voyager::test
