// A .voy file whose checksums were made right, opened whole and streamed, and drawn. A frame that
// waits for what it needs is the frame of the whole scene, to the bit; a file that is not sound may
// be refused at any moment, and never does more harm than that.
#include <cstring>
#include <optional>

#include "runtime/base/error.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/open_streamed.h"
#include "tests/fuzz/memory_limit.h"
#include "tests/fuzz/small_frame.h"
#include "tests/support/sealed.h"

namespace voyager::fuzz {
namespace {

using test::Bytes;

struct Look {
  double back, tau;
};
constexpr Look kWalk[] = {{1.5, 30}, {0.4, 3}, {0, 0.5}, {1.5, 3}};

std::pmr::memory_resource* memory() {
  return std::pmr::get_default_resource();
}

// The result of `action`, or nothing where it fails as it may.
template <class Action>
auto unless_refused(const Action& action) -> std::optional<decltype(action())> {
  try {
    return action();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) std::abort();
    return std::nullopt;
  }
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

class Walk {
 public:
  explicit Walk(const Bytes& bytes)
      : source_(std::make_shared<MemorySource>("fuzz.voy", bytes)),
        backend_(create_cpu_backend()) {}

  // Frames of the whole scene; false where it is refused or damaged.
  bool whole() {
    const auto scene = unless_refused([&] { return load_scene(source_, memory(), workers()); });
    if (!scene) return false;
    View view(*scene, *backend_, {}, memory(), workers());
    for (const Look& look : kWalk)
      pictures_.push_back(unless_refused([&] { return draw(view, frame(**scene, look)); }));
    return (*scene)->damaged.empty();
  }

  // The same walk with room for all chunks, then for the top and one more: frames as it comes,
  // then frames that wait. `sound`: what whole() said.
  void streamed(bool sound) {
    const auto scene = unless_refused([&] { return open(); });
    if (!scene && sound) std::abort();
    if (!scene) return;
    hurry(*scene);
    wait(*scene, false, sound, true);
    wait(*scene, true, sound, true);
    if (!(*scene)->stream || !unless_refused([&] { return leave_room(**scene); })) return;
    hurry(*scene);
    wait(*scene, false, sound, false);
    wait(*scene, true, false, false);
  }

 private:
  static Workers& workers() {
    static Workers workers(1);
    return workers;
  }

  FrameInput frame(const Scene& scene, const Look& look) const {
    return frame_of(scene, look.back, look.tau);
  }

  static bool step(Scene& scene) {
    return unless_refused([&] { return scene.stream->step(); }).value_or(false);
  }

  std::shared_ptr<Scene> open() {
    StreamingDesc desc;
    desc.readers = 0;
    desc.first_bytes = 0;
    desc.clock = [this] { return time_ += 0.1; };  // each look at it takes a moment
    return open_streamed(source_, desc, *backend_, memory(), workers());
  }

  bool leave_room(Scene& scene) {
    const SceneFile& file = scene.stream->file();
    const RoomBytes room = backend_->room_bytes(scene, SceneStream::slot_shape(file));
    const uint32_t slots = SceneStream::top_chunks(file) + 1;
    scene.stream->set_budget(room.of(RecordRoom(file).of(slots)), workers());
    return true;
  }

  // Frames that wait for nothing.
  void hurry(const std::shared_ptr<Scene>& scene) {
    View view(scene, *backend_, {}, memory(), workers(), [this] { return time_ += 0.1; });
    for (const Look& look : kWalk) {
      unless_refused([&] { return draw(view, frame(*scene, look)); });
      for (int steps = 0; steps < 3 && scene->stream && step(*scene); ++steps) {
      }
    }
  }

  // complete: there is room for all, so that a sound scene is drawn.
  void wait(const std::shared_ptr<Scene>& scene, bool stand_in, bool sound, bool complete) {
    View view(scene, *backend_, {}, memory(), workers(), [this] { return time_ += 0.1; });
    for (size_t i = 0; i < std::size(kWalk); ++i) {
      FrameInput input = frame(*scene, kWalk[i]);
      input.wait_resident = true;
      input.stand_in = stand_in;
      const auto picture = unless_refused([&] { return draw(view, input); });
      if (!sound || !pictures_[i] || (!picture && !complete)) continue;
      if (!picture || picture->cut != pictures_[i]->cut ||
          !same_bits(picture->rgba, pictures_[i]->rgba) ||
          !same_bits(picture->depth, pictures_[i]->depth))
        std::abort();
    }
  }

  std::shared_ptr<MemorySource> source_;
  std::unique_ptr<Backend> backend_;
  std::vector<std::optional<Picture>> pictures_;
  double time_ = 0;
};

void open_both_ways(const Bytes& bytes) {
  const MemoryLimit limit(bytes.size());
  Walk walk(bytes);
  const bool sound = walk.whole();
  walk.streamed(sound);
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  voyager::fuzz::open_both_ways(voyager::test::sealed({first, first + size}));
  return 0;
}
