#pragma once
// The chunks of a streamed scene in a device's memory.
//
// Chunks and links go to the device on a stream of the pool's own, in the order in which they
// are given. What links them waits there for the frames in flight, which read what it changes,
// and frames that come later wait for it. A slot that is free again was unlinked before, so
// that what fills it, behind that in the stream, overwrites nothing that a frame still reads.
// No frame waits on the host.
#include <mutex>
#include <vector>

#include "cuda/device/device.h"
#include "cuda/scene/code_tables.h"
#include "cuda/scene/gaussian_view.h"
#include "cuda/stream/patch_buffers.h"
#include "cuda/stream/upload_ring.h"
#include "runtime/stream/record_bounds.h"

namespace voyager::cuda {

class PoolReader;

class DevicePool final : public ChunkPool {
 public:
  static PoolBytes bytes(const Device& device, const Scene& scene, SlotShape shape);

  // Takes all its memory. The scene outlives it; its description is complete. Throws
  // Error(over_budget) for want of memory, Error(unsupported) where there are more addresses than
  // 32 bits.
  DevicePool(std::shared_ptr<const Device> device, const Scene& scene,
             std::shared_ptr<const SceneFile> file, SlotShape shape, PoolRoom room);
  ~DevicePool() override;
  DevicePool(const DevicePool&) = delete;
  DevicePool& operator=(const DevicePool&) = delete;

  // May wait for a piece of the ring, which is to say for chunks that came before it, and for the
  // frames that those wait for: throws Error(timeout), too.
  void fill(std::span<const StagedChunk* const> chunks) override;
  const BoundsCode& bounds(const CheckedRecord& of) const override {
    return bounds_.at(of.slot, of.checked);
  }
  void apply(const LinkPatch& patch) override;
  void await_frames() override;
  // Until the last links are the device's. Throws Error(timeout) as await_frames() does.
  void await_links() const;
  // Waits for the device.
  void resize(PoolRoom room) override;

  const Device& device() const { return *device_; }
  // Until it is resized.
  GaussianView gaussians() const;
  TreeView tree() const;
  PoolNodes nodes() const;
  uint32_t slots() const { return slots_; }
  uint32_t slot_nodes() const { return shape_.nodes; }
  // What is linked in each, under SceneStream::hold().
  const std::vector<SlotIds>& slot_ids() const { return slot_ids_; }

 private:
  friend class PoolReader;

  template <class T>
  T* array(PoolArray which) const {
    return reinterpret_cast<T*>(memory_.data() + layout_.begin(which));
  }
  void pack(const StagedChunk& chunk, unsigned char* into) const;
  void pack_codes(const StagedChunk& chunk, unsigned char* into) const;
  void pack_floats(const StagedChunk& chunk, unsigned char* into) const;
  void fill_piece(std::span<const StagedChunk* const> chunks);
  // With the page that stands for all that has no place.
  uint32_t place_count() const { return (pages_ + 1) * kPageSubtrees; }
  // Throws Error(over_budget) where a resize has left no memory.
  void require_room() const;
  void put_behind_frames();
  void make_room(PoolRoom room);

  const std::shared_ptr<const Device> device_;
  const std::shared_ptr<const CodeTables> tables_;  // of a coded scene
  const SlotShape shape_;
  const int sh_degree_;
  const ShForm sh_form_;
  const bool doubles_, footprints_;
  const float blend_share_;
  const std::shared_ptr<const SceneFile> file_;
  const PoolLayout chunk_layout_;  // of one on its way
  PoolLayout layout_;
  uint32_t slots_ = 0, pages_ = 0, families_ = 0;
  Buffer<unsigned char> memory_;
  RecordBounds bounds_;
  std::vector<SlotIds> slot_ids_;
  UploadRing ring_;
  PatchBuffers patches_;
  Event applied_{cudaEventDisableTiming};
  std::mutex readers_mutex_;
  std::vector<PoolReader*> readers_;
  Stream stream_;
};

// The scene's. Throws Error(unsupported) where it lies elsewhere than on the device.
DevicePool& pool_of(const Scene& scene, const Device& device);

// One stream's frames that read a pool, which outlives it. begin() and end() are called under
// SceneStream::hold(), and so not while a patch is applied.
class PoolReader {
 public:
  explicit PoolReader(DevicePool& pool);
  ~PoolReader();
  PoolReader(const PoolReader&) = delete;
  PoolReader& operator=(const PoolReader&) = delete;

  // What comes on the stream from now on finds what was linked. Throws Error(over_budget) where
  // the pool has lost its memory.
  void begin(cudaStream_t stream) const;
  // What was launched on the stream so far has to end before links change.
  void end(cudaStream_t stream) noexcept;

 private:
  friend class DevicePool;

  DevicePool& pool_;
  Event ended_{cudaEventDisableTiming};
  bool reading_ = false;  // since links changed last
};

}  // namespace voyager::cuda
