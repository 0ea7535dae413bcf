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

// .spz, version 4 (NGSP header, zstd streams) or 3 (one gzip stream, which readers of 2025 and
// before know). Each attribute is spooled to a temporary file, so memory does not grow with `count`
// (at most 2^32 - 1). Positions are 24-bit fixed point with spz_fractional_bits(); a coordinate
// beyond what then fits is an error, never clamped. Other parameters are rounded to the nearest
// step and clamped to the format's range: log scale [-10, 5.9375], SH [-1, 0.992], f_dc [-10/3,
// 10/3]. The flag says that a scene was trained with a compensated filter, not which: it is read
// as 3DGS's.
std::unique_ptr<GaussianWriter> write_spz(ByteSink& sink, uint64_t count, int sh_degree,
                                          float largest_coordinate = 2047.0f, int version = 4);

// 12, which is 1/4096 m, or as many as fit where `largest_coordinate` (metres, world) is greater.
int spz_fractional_bits(float largest_coordinate);
// Inside a .glb, whose positions are from its node on: more, up to 20, where steps of 1/4096 m are
// above the 2^17th part of `largest_coordinate`.
int spz_fractional_bits_inside(float largest_coordinate);

// antimatter15's .splat: binary32 positions (world) and scales; colour, opacity and rotation in a
// byte each, rounded to the nearest step and clamped to the format's range. SH of degree 1 and
// more, and the filter of the training, are left out. INRIA's axes.
std::unique_ptr<GaussianWriter> write_splat(ByteSink& sink, uint64_t count, int sh_degree);
inline constexpr size_t kSplatBytes = 32;  // a Gaussian

// PlayCanvas' .compressed.ply: chunks of 256 Gaussians with their bounds, between which positions
// and log scales have 11, 10 and 11 bits and colours 8; rotations have three of 10 bits, opacities
// 8, SH 8 bits from -4 to 4, where they are clamped. INRIA's axes; positions are of the world.
// Gaussians are reordered along a Morton curve, 262,144 at a time, which keeps bounds tight; that
// many are held. All batches have one origin. native: as write_ply() says it.
std::unique_ptr<GaussianWriter> write_compressed_ply(PlacedSink& sink, uint64_t count,
                                                     int sh_degree, const NativeScale& native = {});

// Bytes of its chunks and rows: what it takes at least.
uint64_t compressed_ply_bytes(uint64_t count, int sh_degree);

// .glb: glTF 2.0's binary container with one primitive of KHR_gaussian_splatting, all in binary32,
// axes turned to glTF's (runtime/scene/gltf_format.h). All batches have one origin, which is the
// node's translation. Scales and opacities are written as they are drawn: logits beyond 16 come
// back as the largest or as another near one. The format has no place for the filter of the
// training. Throws Error(unsupported) for no Gaussians, and for 4 GiB of them (18 million of SH
// degree 3).
std::unique_ptr<GaussianWriter> write_glb(PlacedSink& sink, uint64_t count, int sh_degree);

// The same compressed, KHR_gaussian_splatting_compression_spz_2: a .spz of Gaussians from the
// node's translation on, as write_spz() writes it but for two things: its numbers are in glTF's
// axes, as CesiumJS takes them, and it has spz_fractional_bits_inside(). largest_coordinate is from
// the node's translation on, too.
std::unique_ptr<GaussianWriter> write_spz_glb(PlacedSink& sink, uint64_t count, int sh_degree,
                                              float largest_coordinate, int version);

// Bytes of its arrays: what it takes at least.
uint64_t glb_bytes(uint64_t count, int sh_degree);

// .sog: PlayCanvas' SOG of version 2, lossless WebP images of codes in a zip. Positions have 16
// bits between the bounds of sign(x) ln(|x| + 1), of the world; rotations three of 8 bits,
// opacities 8; log scales and f_dc the nearest of 256 values each, SH of degree 1 to 3 one of up to
// 65,536 sets (sog/sh_sets.h) of 256 values. Gaussians are reordered along a Morton curve. All are
// held, some 400 bytes each at SH degree 3, until finish(), which does the work. All batches have
// one origin. INRIA's axes. The flag says that a scene was trained with a compensated filter, not
// which: it is read as 3DGS's. Throws Error(unsupported) for no Gaussians and for more than 268
// million, and where require_sog() does.
std::unique_ptr<GaussianWriter> write_sog(ByteSink& sink, uint64_t count, int sh_degree,
                                          const NativeScale& native = {});

// Throws Error(unsupported) where libvoyager_sog.so is missing.
void require_sog();

}  // namespace voyager
