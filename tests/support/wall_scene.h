#pragma once
// A wall with a scene in its shadow, streamed so that a test sees in which order it is read.
#include <mutex>
#include <random>

#include "runtime/frame/open_streamed.h"
#include "tests/support/random_trees.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::test {

inline constexpr float kBehindWall = 30;  // metres: what is not the wall is farther along z

// A wall of opaque discs that fills the image, and as many specks, all in its shadow.
inline GaussianCloud wall_and_specks() {
  std::mt19937 random(1);
  const auto within = [&](float low, float high) { return low + (high - low) * unit(random); };
  GaussianCloud cloud = random_cloud(8000, 2, 3);
  for (size_t i = 0; i < cloud.size(); ++i) {
    const bool wall = i % 2 == 0;
    float* const position = &cloud.position[3 * i];
    const float reach = wall ? 8 : 20;
    position[0] = within(-reach, reach), position[1] = within(-reach, reach);
    position[2] = wall ? within(0, 0.1f) : within(kBehindWall, 2 * kBehindWall);
    for (size_t k = 0; k < 3; ++k) cloud.log_scale[3 * i + k] = std::log(wall ? 0.6f : 0.5f);
    for (size_t k = 0; k < 4; ++k) cloud.rotation[4 * i + k] = k == 0 ? 1.0f : 0.0f;
    if (wall) cloud.log_scale[3 * i + 2] = std::log(0.02f);
    cloud.opacity[i] = 6;
    const size_t sh = cloud.sh.size() / cloud.size();
    if (wall) std::fill_n(cloud.sh.begin() + static_cast<std::ptrdiff_t>(sh * i), sh, 0.3f);
  }
  return cloud;
}

inline const Bytes& wall_bytes() {
  static const Bytes bytes =
      scene_bytes(bake(wall_and_specks()), Quality::lossless, 0, kMinChunkBytes);
  return bytes;
}

inline FrameInput before_the_wall() {
  return frame_input(look({0, 0, -9}, {0, 0, 0}, 96, 96, 60), 0.5);
}
inline FrameInput behind_the_wall() {
  return frame_input(look({0, 0, 20}, {0, 0, 0}, 96, 96, 60), 0.5);
}

// Knows what was read.
class LoggedSource final : public ByteSource {
 public:
  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return source_->size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    source_->read(offset, into);
    const std::lock_guard lock(mutex_);
    reads_.emplace_back(offset, offset + into.size());
  }
  // Of a chunk of the wall and one behind it, how likely the latter was read later.
  double behind_later(const ChunkDirectory& chunks) const {
    size_t of_wall = 0, behind = 0, later = 0;
    for (const auto& [begin, end] : reads_)
      for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk) {
        if (chunks[chunk].offset < begin || chunks[chunk].offset >= end) continue;
        const EntryHull hull = chunks.hull(chunk);
        if (hull.box_max.z < kBehindWall / 2) ++of_wall;
        if (hull.box_min.z < kBehindWall / 2) continue;
        ++behind;
        later += of_wall;
      }
    return static_cast<double>(later) / static_cast<double>(of_wall * behind);
  }

 private:
  std::shared_ptr<const ByteSource> source_ = source_of(wall_bytes());
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<uint64_t, uint64_t>> reads_;
};

// The scene, streamed without threads, and a view of it.
class StreamedWall {
 public:
  // told: what frames show counts. If not, there is somebody else who sees nothing, and tells
  // nothing. share: of the memory that all chunks take.
  StreamedWall(Backend& backend, bool told, const PipelineDesc& desc = {}, double share = 1)
      : scene_(open(backend, share)), view_(scene_, backend, desc, memory(), workers_) {
    Viewer nobody;
    nobody.query.target_size = INFINITY;
    if (!told) stream().look(&nobody_, {nobody});
  }

  Frame draw(const FrameInput& input) { return render(view_, input); }
  // So many frames, and a step behind each.
  void begin(const FrameInput& input, int frames) {
    for (int i = 0; i < frames; ++i) {
      draw(input);
      stream().step();
    }
  }
  // So many frames behind each two steps, until nothing is left to do.
  Frame settle(const FrameInput& input, int frames = 1) {
    Frame frame = draw(input);
    for (int idle = 0; idle < 2;) {
      const bool done = stream().step();
      stream().step();
      idle = done ? 0 : idle + 1;
      for (int i = 0; i < frames; ++i) frame = draw(input);
    }
    return frame;
  }
  double behind_later() const { return source_->behind_later(stream().file().chunks()); }
  SceneStream& stream() const { return *scene_->stream; }
  const std::shared_ptr<Scene>& scene() const { return scene_; }

 private:
  static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }
  std::shared_ptr<Scene> open(Backend& backend, double share) {
    StreamingDesc desc;
    desc.readers = 0;
    desc.first_bytes = 0;
    if (share < 1) {
      const SceneFile file(source_);
      const auto slots = static_cast<uint32_t>(share * static_cast<double>(file.chunks().size()));
      const auto resident = load_scene(source_, memory(), workers_);
      desc.budget = backend.room_bytes(*resident, SceneStream::slot_shape(file))
                        .of(RecordRoom(file).of(slots));
    }
    return open_streamed(source_, desc, backend, memory(), workers_);
  }

  Workers workers_;
  std::shared_ptr<LoggedSource> source_ = std::make_shared<LoggedSource>();
  std::shared_ptr<Scene> scene_;
  View view_;
  char nobody_ = 0;
};

}  // namespace voyager::test
