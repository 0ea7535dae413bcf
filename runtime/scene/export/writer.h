#pragma once
// Flat scenes out, as they are generated: a writer takes batches and never
// holds the whole. Batches are in INRIA axes and parameters, like everything
// else; each format converts for itself. Not safe to share between threads.
#include <cstdint>
#include <memory>
#include <span>

#include "runtime/base/file.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

class GaussianWriter {
 public:
  virtual ~GaussianWriter() = default;
  // Throws Error(invalid_argument) where the batch is of another SH degree, is
  // one too many, or holds what the format cannot say; Error(io) from the sink.
  virtual void append(const GaussianCloud& batch) = 0;
  // Called once, after `count` Gaussians in all (else Error(invalid_argument));
  // the caller then commits the file.
  virtual void finish() = 0;
};

// Where the bytes go: an AtomicFile or standard output. Throws Error(io).
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write(std::span<const std::byte> bytes) = 0;
};
// One that can also be written at any place, for formats whose arrays grow side by side.
class PlacedSink : public ByteSink {
 public:
  // From `offset` on, also beyond what is there; write() goes on where it was.
  virtual void write_at(uint64_t offset, std::span<const std::byte> bytes) = 0;
};
// The file must outlive the sink, and the sink its writer.
std::unique_ptr<PlacedSink> sink_to(AtomicFile& file);
std::unique_ptr<ByteSink> sink_to_stdout();

// Binary little-endian .ply in INRIA's property order: x y z nx ny nz f_dc_* f_rest_* opacity
// scale_* rot_*. `count` and `sh_degree` (0-3) are announced in the header. Words are kept to the
// bit. A cloud with a non-zero origin needs double_positions: x, y, z are then world coordinates.
// native: a comment says so where the scene was trained with a compensated filter.
std::unique_ptr<GaussianWriter> write_ply(ByteSink& sink, uint64_t count, int sh_degree,
                                          bool double_positions = false,
                                          const NativeScale& native = {});

// Bytes of its rows: what it takes at least.
uint64_t ply_bytes(uint64_t count, int sh_degree, bool double_positions = false);

// .spz v4 (NGSP header, zstd streams). Each stream is spooled to a temporary file, so memory does
// not grow with `count` (at most 2^32 - 1). Positions are 24-bit fixed point with 12 fractional
// bits (1/4096 m), fewer where `largest_coordinate` (metres, world) does not fit; a coordinate
// beyond what then fits is an error, never clamped. Other parameters are rounded to the nearest
// step and clamped to the format's range: log scale [-10, 5.9375], SH [-1, 0.992], f_dc [-10/3,
// 10/3]. The flag says that a scene was trained with a compensated filter, not which: it is read
// as 3DGS's.
std::unique_ptr<GaussianWriter> write_spz(ByteSink& sink, uint64_t count, int sh_degree,
                                          float largest_coordinate = 2047.0f);

}  // namespace voyager
