#pragma once
// A random flight of two views through one scene, each on a thread of its own, while threads
// read, reads fail, and the budget changes: for sanitizers, and for hours.
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "runtime/frame/whole_tree.h"
#include "tests/support/random_trees.h"
#include "tests/support/stream_rig.h"

namespace voyager::test {

inline double number_from(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atof(text);
}

// Fails at one read in fifty, and lies at another.
class FaultySource final : public ByteSource {
 public:
  FaultySource(Bytes bytes, uint32_t seed) : bytes_(std::move(bytes)), count_(seed) {}
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
  const Bytes bytes_;
  mutable std::atomic<uint32_t> count_;
};

inline double host_megabytes() {
  uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
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

// As long as VOYAGER_FLIGHT_SECONDS says, from the seed that VOYAGER_FLIGHT_SEED names. Each frame
// draws a cut; the memory that its tenths take, by `megabytes`, does not grow from the first
// ones to the last ones of a flight of a minute or more; and once reads are sound, whoever stands
// sees the resident image.
inline void fly_streamed(Backend& backend, const std::function<double()>& megabytes) {
  const double seconds = number_from("VOYAGER_FLIGHT_SECONDS", 3);
  const auto seed = static_cast<uint32_t>(number_from("VOYAGER_FLIGHT_SEED", 1));
  GaussianCloud cloud = random_cloud(8000, seed, 1);
  for (float& x : cloud.position) x *= 20;
  const auto source = std::make_shared<FaultySource>(
      scene_bytes(bake(cloud), Quality::compact, 0, kMinChunkBytes), seed);
  const auto memory = std::pmr::get_default_resource();
  Workers workers(2);
  const auto resident = load_scene(source, memory, workers);
  const SceneFile file(source);
  const RoomBytes bytes = backend.room_bytes(*resident, SceneStream::slot_shape(file));
  constexpr size_t kViews = 2;
  const auto budget_of = [&](double share) {
    return bytes.of(RecordRoom(file).of(
                        static_cast<uint32_t>(share * static_cast<double>(file.chunks().size()))),
                    kViews);
  };
  StreamingDesc desc;
  desc.budget = budget_of(0.5);
  desc.readers = 3;
  desc.first_bytes = 0;
  const auto scene = open_streamed(source, desc, backend, memory, workers);
  source->faulty = true;

  const auto begin = std::chrono::steady_clock::now();
  const auto flown = [&] {
    const auto since = std::chrono::steady_clock::now() - begin;
    return std::chrono::duration<double>(since).count() / seconds;
  };
  std::atomic<uint64_t> frames{0};
  const auto fly = [&](uint32_t own_seed) {
    RandomFlight flight(own_seed);
    View view(scene, backend, {}, memory, workers);
    while (flown() < 1 && !testing::Test::HasFailure()) {
      try {
        const Frame frame = render(view, flight.next());
        EXPECT_TRUE(is_cut(*whole_tree(*resident), frame.cut));
        ++frames;
      } catch (const Error& error) {
        // The budget changed between the frame and the reading of its cut.
        EXPECT_NE(std::string(error.what()).find("shared out anew"), std::string::npos)
            << error.what();
      }
    }
  };
  std::thread other(fly, seed + 1000);
  std::vector<double> peaks(10);
  std::thread budgets([&] {
    std::mt19937 random(seed);
    for (double now = flown(); now < 1; now = flown()) {
      scene->stream->set_budget(budget_of(0.05 + 0.9 * double{unit(random)}), workers);
      double& peak = peaks[static_cast<size_t>(10 * now)];
      peak = std::max(peak, megabytes());
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  });
  fly(seed);
  other.join();
  budgets.join();
  if (seconds >= 60) {
    EXPECT_LT(*std::max_element(peaks.begin() + 7, peaks.end()),
              1.2 * *std::max_element(peaks.begin(), peaks.begin() + 3));
  }

  source->faulty = false;
  scene->stream->set_budget(0, workers);
  FrameInput input = frame_input(look({0, -3, -150}, {0, -3, 0}, 32, 24, 70), 2);
  View part(scene, backend, {}, memory, workers), whole(resident, backend, {}, memory, workers);
  input.wait_resident = true;
  expect_same_bits(render(part, input), render(whole, input));
  EXPECT_GT(frames, 0u);
  std::printf(
      "seed %u, %.0f s: %llu frames, %llu failures, %.1f MB in the first tenth, %.1f in the last\n",
      seed, seconds, static_cast<unsigned long long>(frames.load()),
      static_cast<unsigned long long>(scene->stream->counters().failures), peaks.front(),
      peaks.back());
}

}  // namespace voyager::test
