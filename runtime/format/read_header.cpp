#include "runtime/format/read_header.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/base/checksum.h"
#include "runtime/lod/tree_rule.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {
namespace {

// Footprint levels beyond the first.
uint32_t levels_of(const FileHeader& h) {
  return h.version == 4 ? 0 : (h.flags & kFootprintMask) >> kFootprintShift;
}

void check_counts(const FileHeader& h, const Check& check) {
  const uint32_t levels = levels_of(h);
  const uint32_t unknown = h.flags & ~(kFlags | levels << kFootprintShift);
  check.equal(offsetof(FileHeader, flags), "unknown flags", unknown, 0);
  check.that((h.flags & kFlagFurther) == 0 || ((h.flags & kFlagKeptTree) != 0 && h.node_count != 0),
             offsetof(FileHeader, flags), "further Gaussians of a tree that is not a .hier's own",
             "none");
  check.at_most(offsetof(FileHeader, flags), "footprint levels beyond the first", levels,
                kFootprintLevels - 1);
  check.that(h.quality == 1 || h.quality == 2, offsetof(FileHeader, quality), "an unknown quality",
             "1 or 2");
  check.at_most(offsetof(FileHeader, sh_degree), "SH degree", h.sh_degree, kMaxShDegree);
  check.at_most(offsetof(FileHeader, left_out_bands), "SH bands left out", h.left_out_bands,
                kMaxShDegree - h.sh_degree);
  check.at_most(offsetof(FileHeader, node_count), "node count", h.node_count, kNoNode - 1);
  check.at_most(offsetof(FileHeader, leaf_count), "leaf count", h.leaf_count, h.node_count);
  check.at_most(offsetof(FileHeader, depth), "depth", h.depth, h.node_count);
  check.at_most(offsetof(FileHeader, subtree_count), "subtree count", h.subtree_count,
                h.node_count);
  check.at_most(offsetof(FileHeader, chunk_count), "chunk count", h.chunk_count, h.subtree_count);
  for (const uint32_t count :
       {h.leaf_count, h.depth, h.subtree_count, h.chunk_count, h.first_tier_levels})
    check.that((count == 0) == (h.node_count == 0), offsetof(FileHeader, node_count),
               "some counts that are 0 and some that are not", "all or none");
  check.that(h.chunk_bytes >= kMinChunkBytes && h.chunk_bytes <= kMaxChunkBytes,
             offsetof(FileHeader, chunk_bytes), "chunk bytes out of range", "1024 to 1048576");
  check.at_most(offsetof(FileHeader, first_tier_levels), "levels of the first tier",
                h.first_tier_levels, kTierLevels);
}

void check_ranges(const FileHeader& h, const Check& check) {
  for (int axis = 0; axis < 3; ++axis) {
    check.that(std::fabs(h.origin[axis]) < double{kMaxCoordinate} &&
                   std::fabs(h.source_origin[axis]) < double{kMaxCoordinate},
               offsetof(FileHeader, origin), "an origin out of range", "finite, below 1e18");
    check.that(h.bounds_min[axis] > -kMaxCoordinate && h.bounds_min[axis] <= h.bounds_max[axis] &&
                   h.bounds_max[axis] < kMaxCoordinate,
               offsetof(FileHeader, bounds_min), "bounds out of range",
               "finite, ordered, below 1e18");
  }
  check.that(h.position_error >= 0 && h.position_error < double{kMaxCoordinate},
             offsetof(FileHeader, position_error), "a position error out of range",
             "finite, not negative");
  check.that(h.largest_sh >= 0 && h.largest_sh <= std::numeric_limits<float>::max(),
             offsetof(FileHeader, largest_sh), "a largest SH coefficient out of range",
             "finite, not negative");
  check.that(h.native_pixel >= 0 && h.native_pixel <= kMaxNativePixel,
             offsetof(FileHeader, native_pixel), "a native pixel out of range", "0 to 1e6 metres");
  check.that(h.low_pass >= 0 && h.low_pass <= kMaxLowPass, offsetof(FileHeader, low_pass),
             "a low-pass out of range", "0 to 100 square pixels");
  check.that(h.native_source <= static_cast<uint32_t>(NativeSource::estimated),
             offsetof(FileHeader, native_source), "an unknown source of the native pixel",
             "0 to 4");
  const auto source = static_cast<NativeSource>(h.native_source);
  const bool has_footprint = source != NativeSource::unknown && source != NativeSource::file;
  check.that(has_footprint || h.native_pixel == 0, offsetof(FileHeader, native_pixel),
             "a native pixel of a scene whose source says that it has none", "0");
  check.that(h.native_pixel > 0 || levels_of(h) == 0, offsetof(FileHeader, flags),
             "footprint levels beyond the first without a native pixel", "none");
  check.that(h.blend_share >= kHalfShare && h.blend_share < 1, offsetof(FileHeader, blend_share),
             "a share of the parent's size out of range", "0.5 or more, below 1");
  const bool empty = h.largest_sh == 0 && (h.flags & kFlagLeafExtents) == 0;
  check.that(h.node_count != 0 || empty, offsetof(FileHeader, largest_sh),
             "SH or extents without nodes", "none");
}

}  // namespace

bool has_scene_magic(std::span<const std::byte> first_bytes) {
  return first_bytes.size() >= sizeof kSceneMagic &&
         std::memcmp(first_bytes.data(), kSceneMagic, sizeof kSceneMagic) == 0;
}

// The version, before anything that depends on it.
uint32_t read_version(const ByteSource& source, const Check& check) {
  constexpr size_t kBegin = offsetof(FileHeader, flags);
  if (source.size() < kBegin)
    check.refuse(0, std::to_string(source.size()) + " bytes",
                 "a header of " + std::to_string(sizeof(FileHeader)));
  std::byte bytes[kBegin];
  source.read(0, bytes);
  check.that(has_scene_magic(bytes), 0, "another signature", "the signature of a .voy file");
  uint32_t version;
  std::memcpy(&version, bytes + offsetof(FileHeader, version), sizeof version);
  if (version < kOldestSceneVersion || version > kSceneVersion)
    check.refuse(offsetof(FileHeader, version), "version " + std::to_string(version),
                 std::to_string(kOldestSceneVersion) + " to " + std::to_string(kSceneVersion) +
                     ": bake the scene again");
  return version;
}

FileHeader read_header(const ByteSource& source, const Check& check) {
  const uint32_t version = read_version(source, check);
  const size_t checked = checked_header_bytes(version), whole = header_bytes(version);
  FileHeader h{};
  if (source.size() < whole)
    check.refuse(0, std::to_string(source.size()) + " bytes",
                 "a header of " + std::to_string(whole));
  std::vector<std::byte> bytes(whole);
  source.read(0, bytes);
  // Where the file does not say.
  h.low_pass = kPixelVariance;
  h.blend_share = kHalfShare;
  std::memcpy(&h, bytes.data(), checked);
  std::memcpy(&h.checksum, bytes.data() + checked, sizeof h.checksum);
  check.equal(offsetof(FileHeader, file_length), "a file of length", source.size(), h.file_length);
  check.equal(checked, "header checksum", checksum(std::span(bytes).first(checked)), h.checksum);
  check_counts(h, check);
  check_ranges(h, check);
  return h;
}

}  // namespace voyager
