#include "cuda/interop/external_ring.h"

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {
namespace {

template <class Handle, cudaError_t (*kDestroy)(Handle)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Handle handle) : handle_(handle) {}
  Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, Handle{})) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Owned() {
    if (handle_ != Handle{}) kDestroy(handle_);
  }
  Handle get() const { return handle_; }

 private:
  Handle handle_{};
};

using Memory = Owned<cudaExternalMemory_t, cudaDestroyExternalMemory>;
using Mipmaps = Owned<cudaMipmappedArray_t, cudaFreeMipmappedArray>;
using Surface = Owned<cudaSurfaceObject_t, cudaDestroySurfaceObject>;
using Semaphore = Owned<cudaExternalSemaphore_t, cudaDestroyExternalSemaphore>;
using Mapped = Owned<void*, cudaFree>;

// The driver owns the descriptor once it has taken it.
Memory import_memory(ExternalMemory& from) {
  cudaExternalMemoryHandleDesc desc{};
  desc.type = cudaExternalMemoryHandleTypeOpaqueFd;
  desc.handle.fd = from.fd.get();
  desc.size = from.size;
  desc.flags = from.dedicated ? cudaExternalMemoryDedicated : 0;
  cudaExternalMemory_t memory = nullptr;
  check(cudaImportExternalMemory(&memory, &desc), "memory of another API");
  from.fd.release();
  return Memory(memory);
}

Semaphore import_semaphore(FileDescriptor& from, bool timeline) {
  cudaExternalSemaphoreHandleDesc desc{};
  desc.type = timeline ? cudaExternalSemaphoreHandleTypeTimelineSemaphoreFd
                       : cudaExternalSemaphoreHandleTypeOpaqueFd;
  desc.handle.fd = from.get();
  cudaExternalSemaphore_t semaphore = nullptr;
  check(cudaImportExternalSemaphore(&semaphore, &desc), "a semaphore of another API");
  from.release();
  return Semaphore(semaphore);
}

cudaChannelFormatDesc channels(ColorFormat format) {
  switch (format) {
    case ColorFormat::rgba8:
      return {8, 8, 8, 8, cudaChannelFormatKindUnsigned};
    case ColorFormat::rgba16f:
      return {16, 16, 16, 16, cudaChannelFormatKindFloat};
    default:
      return {32, 32, 32, 32, cudaChannelFormatKindFloat};
  }
}

// A plane of a slot, all layers.
struct SurfaceImage {
  Memory memory;
  Mipmaps mipmaps;
  Surface surface;
};

SurfaceImage import_image(ExternalImage& from, const cudaChannelFormatDesc& format,
                          const ExternalRingDesc& desc) {
  SurfaceImage image;
  image.memory = import_memory(from.memory);
  cudaExternalMemoryMipmappedArrayDesc array{};
  array.offset = from.memory.offset;
  array.formatDesc = format;
  array.extent = cudaExtent{desc.width, desc.height, desc.layers > 1 ? desc.layers : 0};
  array.flags = cudaArraySurfaceLoadStore;
  if (desc.layers > 1) array.flags |= cudaArrayLayered;
  if (from.color_attachment) array.flags |= cudaArrayColorAttachment;
  array.numLevels = 1;
  cudaMipmappedArray_t mipmaps = nullptr;
  check(cudaExternalMemoryGetMappedMipmappedArray(&mipmaps, image.memory.get(), &array),
        "an image of another API");
  image.mipmaps = Mipmaps(mipmaps);
  cudaResourceDesc level{};
  level.resType = cudaResourceTypeArray;
  check(cudaGetMipmappedArrayLevel(&level.res.array.array, mipmaps, 0), "an image of another API");
  cudaSurfaceObject_t surface = 0;
  check(cudaCreateSurfaceObject(&surface, &level), "a surface");
  image.surface = Surface(surface);
  return image;
}

struct Slot {
  SurfaceImage color, depth;
  Memory limit_memory;
  Mapped limits;
  Semaphore released, rendered;
  bool waited = false;  // for `released`, by a frame that was not drawn yet
};

// Between the stream of a part of a device and the whole device's, which semaphores want.
struct Bridge {
  explicit Bridge(const Device& device) {
    device.use();
    of_part.emplace(cudaEventDisableTiming);
    device.use_whole();
  }
  Stream whole;
  Event of_whole{cudaEventDisableTiming};
  std::optional<Event> of_part;
};

class Ring final : public ExternalRing {
 public:
  Ring(std::shared_ptr<const Device> device, ExternalRingDesc desc);
  ~Ring() override { cudaSetDevice(device_->ordinal()); }

  bool idle() const override;
  void wait() const override {
    device_->use_whole();
    last_frame_.wait();
  }

  const ExternalRingDesc& desc() const { return desc_; }
  Slot& slot(uint32_t index) { return slots_[index]; }
  // Timelines serve the whole ring.
  const Slot& semaphores(uint32_t index) const {
    return slots_[desc_.sync == ExternalSync::timeline ? 0 : index];
  }
  // work(stream), on a stream that takes semaphores, in the order of `stream`'s work.
  template <class Work>
  void on_whole(cudaStream_t stream, const Work& work) const {
    if (!bridge_) return work(stream);
    const cudaStream_t whole = bridge_->whole.get();
    bridge_->of_part->record(stream);
    check(cudaStreamWaitEvent(whole, bridge_->of_part->get(), 0), "a part of the device");
    work(whole);
    bridge_->of_whole.record(whole);
    check(cudaStreamWaitEvent(stream, bridge_->of_whole.get(), 0), "a part of the device");
  }
  const Event& last_frame() const { return last_frame_; }

 private:
  void import_slot(ExternalSlot& from, bool with_semaphores);

  std::shared_ptr<const Device> device_;
  ExternalRingDesc desc_;
  std::vector<Slot> slots_;
  Event last_frame_{kWaitedFor};
  std::optional<Bridge> bridge_;
};

Ring::Ring(std::shared_ptr<const Device> device, ExternalRingDesc desc)
    : device_(std::move(device)), desc_(std::move(desc)) {
  if (device_->is_part()) bridge_.emplace(*device_);
  slots_.reserve(desc_.slots.size());
  for (ExternalSlot& slot : desc_.slots)
    import_slot(slot, desc_.sync == ExternalSync::binary || slots_.empty());
  desc_.slots.clear();
}

void Ring::import_slot(ExternalSlot& from, bool with_semaphores) {
  Slot slot;
  if (desc_.format != ColorFormat::none)
    slot.color = import_image(from.color, channels(desc_.format), desc_);
  if (desc_.depth)
    slot.depth = import_image(from.depth, {32, 0, 0, 0, cudaChannelFormatKindFloat}, desc_);
  if (desc_.depth_limit) {
    slot.limit_memory = import_memory(from.depth_limit);
    cudaExternalMemoryBufferDesc buffer{};
    buffer.offset = from.depth_limit.offset;
    buffer.size = from.depth_limit.size;
    void* mapped = nullptr;
    check(cudaExternalMemoryGetMappedBuffer(&mapped, slot.limit_memory.get(), &buffer),
          "a buffer of another API");
    slot.limits = Mapped(mapped);
  }
  if (desc_.sync != ExternalSync::none && with_semaphores) {
    const bool timeline = desc_.sync == ExternalSync::timeline;
    slot.released = import_semaphore(from.released, timeline);
    slot.rendered = import_semaphore(from.rendered, timeline);
  }
  slots_.push_back(std::move(slot));
}

bool Ring::idle() const {
  cudaSetDevice(device_->ordinal());
  // A device that is lost does nothing more.
  return cudaEventQuery(last_frame_.get()) != cudaErrorNotReady;
}

Ring& ring_of(const ExternalTarget& target) {
  return static_cast<Ring&>(*target.ring);
}

}  // namespace

std::unique_ptr<ExternalRing> import_ring(std::shared_ptr<const Device> device,
                                          ExternalRingDesc desc) {
  device->use_whole();
  return std::make_unique<Ring>(std::move(device), std::move(desc));
}

void wait_for_host(const Event& event) {
  const auto start = std::chrono::steady_clock::now();
  while (!event.passed()) {
    if (std::chrono::steady_clock::now() - start >= kHostPatience)
      throw Error(ErrorCode::timeout, "view: found a frame in flight that did not end within " +
                                          std::to_string(kHostPatience.count()) +
                                          " s, expected the host to signal what it waits for");
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

void wait_for_host(cudaStream_t stream) {
  const cudaError_t status = cudaStreamQuery(stream);
  if (status == cudaSuccess) return;
  if (status != cudaErrorNotReady) check(status, "a frame");
  const Event done(kWaitedFor);
  done.record(stream);
  wait_for_host(done);
}

RasterTarget raster_target(const ExternalTarget& target, const Vec3f& background) {
  Ring& ring = ring_of(target);
  const Slot& slot = ring.slot(target.slot);
  RasterTarget out{};
  out.format = ring.desc().format;
  out.width = ring.desc().width;
  out.height = ring.desc().height;
  out.background = background;
  out.color_surface = slot.color.surface.get();
  out.depth_surface = slot.depth.surface.get();
  out.layered = ring.desc().layers > 1;
  out.layer = target.layer;
  return out;
}

DepthLimits depth_limits(const ExternalTarget& target, const DepthEncoding& encoding) {
  Ring& ring = ring_of(target);
  const size_t row = ring.desc().width, pixels = row * ring.desc().height;
  const auto* all = static_cast<const float*>(ring.slot(target.slot).limits.get());
  return {all + target.layer * pixels, row * sizeof(float), encoding};
}

// A binary semaphore's signal is there once: where the frame that waited was not drawn, the
// next has waited already.
void wait_released(const ExternalTarget& target, cudaStream_t stream) {
  Ring& ring = ring_of(target);
  bool& waited = ring.slot(target.slot).waited;
  const bool waits = target.waits && !(waited && ring.desc().sync == ExternalSync::binary);
  const cudaExternalSemaphore_t semaphore = ring.semaphores(target.slot).released.get();
  cudaExternalSemaphoreWaitParams params{};
  params.params.fence.value = target.wait_value;
  ring.on_whole(stream, [&](cudaStream_t on) {
    // Frames of other views, on other streams, into the ring.
    check(cudaStreamWaitEvent(on, ring.last_frame().get(), 0), "a ring's frames");
    if (!waits) return;
    check(cudaWaitExternalSemaphoresAsync(&semaphore, &params, 1, on),
          "waiting for a semaphore of another API");
    ring.last_frame().record(on);
  });
  waited = waited || waits;
}

void signal_rendered(const ExternalTarget& target, cudaStream_t stream) {
  Ring& ring = ring_of(target);
  const cudaExternalSemaphore_t semaphore = ring.semaphores(target.slot).rendered.get();
  cudaExternalSemaphoreSignalParams params{};
  params.params.fence.value = target.signal_value;
  if (target.signals)
    ring.on_whole(stream, [&](cudaStream_t on) {
      check(cudaSignalExternalSemaphoresAsync(&semaphore, &params, 1, on),
            "signalling a semaphore of another API");
    });
  ring.slot(target.slot).waited = false;
}

void mark_end(const ExternalTarget& target, cudaStream_t stream) {
  const Ring& ring = ring_of(target);
  ring.on_whole(stream, [&](cudaStream_t on) { ring.last_frame().record(on); });
}

}  // namespace voyager::cuda
