#pragma once
// A flat scene as a file, in the format that the file's name asks for.
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/scene/export/writer.h"

namespace voyager {

enum class FlatFormat { ply, compressed_ply, spz, splat, glb, sog };

struct FlatOptions {
  int spz_version = 4;      // 3 or 4, of a .spz, also inside of a .glb
  bool spz_inside = false;  // of a .glb: compressed
};

// By the end of the name, in any case; none for a name that is no format's.
std::optional<FlatFormat> flat_format_of(const std::string& path);
// The ends of names, each with its dot.
std::vector<std::string> flat_format_endings();

// Gaussians with a value that the format clamps (value_range.h).
struct ClampedCounts {
  uint64_t spz = 0, splat = 0, compressed_ply = 0;

  void add(const ClampedCounts& more);
};

// What a writer has to know before the first Gaussian.
struct FlatContents {
  uint64_t count = 0;
  int sh_degree = 0;
  NativeScale native;
  std::array<double, 3> origin{0, 0, 0};  // that all batches have
  double largest_coordinate = 0;          // metres, of the world, on any axis
  std::array<double, 3> least{}, most{};  // metres, of the world; 0 where count is
  ClampedCounts clamped;
  ImportReport report;

  void add(const GaussianCloud& batch);
  bool is_moved() const { return origin != std::array<double, 3>{0, 0, 0}; }
  // largest_coordinate in binary32, rounded up.
  float reach() const;
  // The same from the origin.
  float reach_from_origin() const;
};

// What the format has no place for, a sentence each: also a native pixel, which none has.
std::vector<std::string> losses(FlatFormat format, const FlatContents& contents,
                                const FlatOptions& options = {});

// Of the native pixel alone, which a .hier has no place for either; empty where there is none.
std::string lost_native_pixel(const NativeScale& native);

// Before the work: throws Error(invalid_argument) for a path that is no format's, Error(io) where
// the file could not be written, or where there is no room for what it takes at least.
void require_flat_file(const std::string& path, const FlatContents& contents,
                       const FlatOptions& options = {});

// `fill` appends batches, contents.count Gaussians in all. Nothing is at `path` before all of them
// are written. Throws as require_flat_file() and the format's writer do.
void write_flat_file(const std::string& path, const FlatOptions& options,
                     const FlatContents& contents,
                     const std::function<void(GaussianWriter&)>& fill);

}  // namespace voyager
