#pragma once
// Another API's images and semaphores, imported by file descriptor.
#include "cuda/device/device.h"
#include "cuda/device/stream.h"
#include "cuda/splat/splat_launch.h"
#include "runtime/frame/external_ring.h"

namespace voyager::cuda {

// Throws Error; what was imported before that is given back.
std::unique_ptr<ExternalRing> import_ring(std::shared_ptr<const Device> device,
                                          ExternalRingDesc desc);

// Until what the stream has so far is done, or the event has passed. Frames in flight may wait for
// the host: throws Error(timeout) after kHostPatience. It looks five times a millisecond.
void wait_for_host(const Event& event);
void wait_for_host(cudaStream_t stream);
inline void wait_for_host(const Stream& stream) {
  wait_for_host(stream.get());
}

// Of a ring that import_ring made.
RasterTarget raster_target(const ExternalTarget& target, const Vec3f& background);
// The host's depth for the target, of a ring that has it.
DepthLimits depth_limits(const ExternalTarget& target, const DepthEncoding& encoding);
// On the stream: until the image is there to be written; that it was written.
void wait_released(const ExternalTarget& target, cudaStream_t stream);
void signal_rendered(const ExternalTarget& target, cudaStream_t stream);
// The frame's last work is on the stream: its end is what ExternalRing waits for.
void mark_end(const ExternalTarget& target, cudaStream_t stream);

}  // namespace voyager::cuda
