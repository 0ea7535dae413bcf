// A random flight of two views through one scene, each on a thread of its own, while threads
// read, reads fail, and the budget changes. As long as VOYAGER_FLIGHT_SECONDS says, from the seed
// that VOYAGER_FLIGHT_SEED names: for ThreadSanitizer, and for hours.
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"

namespace voyager {
namespace {

using test::Frame;
using test::frame_input;
using test::is_cut;
using test::look;
using test::render;

double number_from(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atof(text);
}

// Fails at one read in fifty, and lies at another.
class FaultySource final : public ByteSource {
 public:
  FaultySource(test::Bytes bytes, uint32_t seed) : bytes_(std::move(bytes)), count_(seed) {}
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return bytes_.size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), into.size(), into.begin());
    if (!faulty) return;
    const uint32_t draw = count_.fetch_add(1) * 2654435761u >> 16;
    if (draw % 50 == 0) throw Error(ErrorCode::io_transient, name_ + ": found a fault");
    if (draw % 50 == 1) into[into.size() / 2] ^= std::byte{1};
  }

  std::atomic<bool> faulty{false};

 private:
  const std::string name_ = "faulty.voy";
  const test::Bytes bytes_;
  mutable std::atomic<uint32_t> count_;
};

long resident_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

class RandomFlight {
 public:
  explicit RandomFlight(uint32_t seed) : random_(seed) {}
  FrameInput next() {
    if (random_() % 90 == 0) eye_ = {place(), -3, place()};
    if (random_() % 20 == 0) way_ = {unit(), 0.1 * unit(), unit()};
    if (random_() % 300 == 0) standing_ = 20;
    if (standing_ > 0)
      --standing_;
    else
      eye_ = eye_ + way_;
    return frame_input(look(eye_, eye_ + Vec3d{way_.x + 0.01, 0.02, way_.z}, 32, 24, 70),
                       random_() % 2 == 0 ? 2 : 5);
  }

 private:
  double unit() { return 2.0 * double{test::unit(random_)} - 1; }
  double place() { return 200 * unit(); }
  std::mt19937 random_;
  Vec3d eye_{0, -3, -150}, way_{0, 0, 1};
  int standing_ = 0;
};

TEST(StreamingFlight, ManyThreadsDrawCutsOnly) {
  const double seconds = number_from("VOYAGER_FLIGHT_SECONDS", 3);
  const auto seed = static_cast<uint32_t>(number_from("VOYAGER_FLIGHT_SEED", 1));
  GaussianCloud cloud = test::random_cloud(8000, seed, 1);
  for (float& x : cloud.position) x *= 20;
  const auto source = std::make_shared<FaultySource>(
      test::scene_bytes(test::bake(cloud), Quality::compact, 0, kMinChunkBytes), seed);
  const auto backend = create_cpu_backend();
  Workers workers(2);
  const auto resident = load_scene(source, std::pmr::get_default_resource(), workers);
  const SceneFile file(source);
  const PoolBytes pool = backend->pool_bytes(*resident, SceneStream::slot_shape(file));
  const auto budget_of = [&](double share) {
    return pool.fixed +
           static_cast<uint64_t>(share * static_cast<double>(file.chunks().size())) * pool.slot;
  };
  StreamingDesc desc;
  desc.budget = budget_of(0.5);
  desc.readers = 3;
  desc.first_bytes = 0;
  const auto scene =
      open_streamed(source, desc, *backend, std::pmr::get_default_resource(), workers);
  source->faulty = true;

  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const auto flying = [&] { return std::chrono::steady_clock::now() < end; };
  std::atomic<uint64_t> frames{0};
  const auto fly = [&](uint32_t own_seed) {
    RandomFlight flight(own_seed);
    View view(scene, *backend, {}, std::pmr::get_default_resource(), workers);
    while (flying() && !testing::Test::HasFailure()) {
      const Frame frame = render(view, flight.next());
      EXPECT_TRUE(is_cut(resident->tree, frame.cut));
      ++frames;
    }
  };
  std::thread other(fly, seed + 1000);
  std::thread budgets([&] {
    std::mt19937 random(seed);
    while (flying()) {
      resize_streamed(*scene, budget_of(0.05 + 0.9 * double{test::unit(random)}), *backend,
                      workers);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  });
  fly(seed);
  other.join();
  budgets.join();
  const long before = resident_kilobytes();

  // Once reads are sound, whoever stands sees the resident image.
  source->faulty = false;
  resize_streamed(*scene, 0, *backend, workers);
  FrameInput input = frame_input(look({0, -3, -150}, {0, -3, 0}, 32, 24, 70), 2);
  View part(scene, *backend, {}, std::pmr::get_default_resource(), workers);
  View whole(resident, *backend, {}, std::pmr::get_default_resource(), workers);
  input.wait_resident = true;
  test::expect_same_bits(render(part, input), render(whole, input));
  EXPECT_GT(frames, 0u);
  RecordProperty("frames", std::to_string(frames));
  std::printf("%llu frames, %llu failures, at most %ld KB\n",
              static_cast<unsigned long long>(frames.load()),
              static_cast<unsigned long long>(scene->stream->counters().failures), before);
}

}  // namespace
}  // namespace voyager
