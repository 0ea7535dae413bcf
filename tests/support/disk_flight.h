#pragma once
// A wide scene on a simulated disk, a view that flies through it, and a pool without content.
#include <atomic>
#include <map>
#include <memory>

#include "runtime/frame/whole_tree.h"
#include "runtime/stream/record_bounds.h"
#include "tests/support/is_cut.h"
#include "tests/support/simulated_disk.h"
#include "tests/support/stream_rig.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {

inline constexpr double kDiskFrame = 1.0 / 60;  // seconds

inline GaussianCloud wide_cloud(size_t count = 20000) {
  GaussianCloud cloud = random_cloud(count, 6, 1);
  for (float& x : cloud.position) x *= 40;
  return cloud;
}

// Baked once a rule for all tests.
inline const Bytes& wide_bytes(const TreeRule& rule) {
  static std::map<std::pair<TreeKind, uint32_t>, Bytes> made;
  Bytes& bytes = made[{rule.kind, rule.block}];
  if (bytes.empty())
    bytes = scene_bytes(bake(wide_cloud(), rule), Quality::lossless, 0, kMinChunkBytes);
  return bytes;
}

inline FrameInput ahead(const Vec3d& eye, const Vec3d& way, double tau = 3) {
  return frame_input(look(eye, eye + way, 61, 45, 60), tau);
}

// Holds nothing but bounds; fails while `fails`, or once.
class FailingPool final : public ChunkPool {
 public:
  explicit FailingPool(PoolRoom room) { bounds_.make_room(room.slots); }

  void fill(std::span<const StagedChunk* const> chunks) override {
    if (late_once.exchange(false))
      throw Error(ErrorCode::timeout, "view: found a frame in flight that did not end");
    for (const StagedChunk* chunk : chunks) bounds_.fill(*chunk);
  }
  const BoundsCode& bounds(const CheckedRecord& of) const override {
    return bounds_.at(of.slot, of.checked);
  }
  void apply(const LinkPatch&) override {
    if (fails || fails_once.exchange(false))
      throw Error(ErrorCode::device_lost, "pool: found no device");
  }
  void resize(PoolRoom room) override {
    if (refuses_once.exchange(false)) throw Error(ErrorCode::over_budget, "pool: found no memory");
    bounds_.make_room(room.slots);
  }
  std::atomic<bool> fails{false}, fails_once{false}, late_once{false}, refuses_once{false};

 private:
  RecordBounds bounds_;
};

// Of a stream with room for all chunks, whose top alone is read at first.
inline StreamDesc desc_of(const SceneFile& file, unsigned readers) {
  StreamDesc desc;
  desc.room = RecordRoom(file).of(static_cast<uint32_t>(file.chunks().size()));
  desc.pinned = desc.first = SceneStream::top_chunks(file);
  desc.readers = readers;
  return desc;
}

// A scene on a disk, and a view of it that draws a frame each 1/60 s.
class DiskFlight {
 public:
  explicit DiskFlight(double share, double latency = 0.002, double bandwidth = 20e6,
                      const TreeRule& rule = {})
      : rig_(wide_bytes(rule), share),
        disk_(std::make_shared<SimulatedDisk>(rig_.bytes, latency, bandwidth)),
        scene_(rig_.open(disk_, share)),
        view_(scene_, *rig_.backend, {}, rig_.memory(), rig_.workers,
              [this] { return rig_.time; }) {
    disk_->start(0);
  }

  // The frame, and what the disk does until the next one.
  Frame draw(const FrameInput& input) {
    Frame frame = render(view_, input);
    EXPECT_TRUE(is_cut(*whole_tree(*rig_.resident), frame.cut));
    EXPECT_LE(counters().resident, counters().slots);
    rig_.time += kDiskFrame;
    disk_->idle_until(rig_.time - kDiskFrame);
    while (disk_->is_free(rig_.time) && stream().step()) continue;
    return frame;
  }
  // Stands until nothing is missing, or for so many frames.
  Frame stand(const FrameInput& input, int frames = 600) {
    Frame frame = draw(input);
    for (int i = 0; i < frames && !(frame.stats.missing == 0 && i > 2); ++i) frame = draw(input);
    return frame;
  }
  Frame whole(const FrameInput& input) { return render(rig_.whole, input); }

  View& view() { return view_; }
  SceneStream& stream() const { return *scene_->stream; }
  StreamCounters counters() const { return stream().counters(); }
  SimulatedDisk& disk() { return *disk_; }
  Scene& scene() { return *scene_; }
  StreamRig& rig() { return rig_; }

 private:
  StreamRig rig_;
  std::shared_ptr<SimulatedDisk> disk_;
  std::shared_ptr<Scene> scene_;
  View view_;
};

}  // namespace voyager::test
