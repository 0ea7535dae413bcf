#include "runtime/format/compact_codec.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "runtime/format/check_chunk.h"
#include "runtime/format/compact_records.h"
#include "runtime/format/compressor.h"
#include "runtime/format/gaussian_planes.h"
#include "runtime/format/quantise.h"

namespace voyager {
namespace {

// First coefficient of a band, from 0 for band 1, or the end.
size_t band_start(size_t band) {
  return static_cast<size_t>(kShBandStart[band]);
}

// Bytes of a Gaussian before compression, and of a chunk.
size_t gaussian_bytes(size_t coefficients) {
  return 3 * 3 + 3 * 2 + 3 * 2 + 2 + 3 * 2 + (coefficients - 1) * 3 + sizeof(uint32_t) +
         sizeof(uint8_t);
}
size_t plane_bytes(size_t records, size_t subtrees, size_t nodes, size_t coefficients,
                   uint32_t version) {
  return records * sizeof(NodeRecord) + subtree_count_bytes(version) * subtrees +
         nodes * gaussian_bytes(coefficients);
}

// Of a box along an axis: what means are stored against. A leaf's is its mean, to the
// rounding of the box.
double box_centre(const NodeRecord& r, int axis) {
  return 0.5 * (double{r.box_min[axis]} + r.box_max[axis]);
}

// Fine enough for the farthest mean of the chunk, and no finer than half the spacing
// of binary32 there, which restores the very words.
double position_step(const Chunk& chunk, int axis) {
  double farthest = 0, largest = 0;
  for (size_t i = 0; i < chunk.words.size(); ++i) {
    const double mean = chunk.words[i].mean[axis];
    farthest = std::max(farthest, std::fabs(mean - box_centre(chunk.record_of(i), axis)));
    largest = std::max(largest, std::fabs(mean));
  }
  const double half_spacing = largest == 0 ? 0 : std::ldexp(1.0, std::ilogb(largest) - 24);
  return std::max(farthest / kPositionSteps, half_spacing);
}

void set_sh_scales(const Chunk& chunk, size_t coefficients, ChunkHeader& header) {
  for (size_t i = 0; i < chunk.words.size(); ++i)
    for (size_t band = 0; band < 3; ++band)
      for (size_t k = 3 * band_start(band); k < 3 * std::min(coefficients, band_start(band + 1));
           ++k)
        header.sh_scale[band] =
            std::max(header.sh_scale[band], std::fabs(chunk.sh[i * coefficients * 3 + k]));
}

// As the decoder will restore them: rounding keeps the order of magnitudes.
float largest_restored_sh(const Chunk& chunk, size_t coefficients, const ChunkHeader& header) {
  float constant = 0;
  for (size_t i = 0; i < chunk.words.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      constant = std::max(constant, std::fabs(chunk.sh[i * coefficients * 3 + c]));
  float largest = half_to_float(float_to_half(constant));
  for (size_t band = 0; band < 3; ++band) {
    const float scale = header.sh_scale[band];
    const int steps = kShSteps[band];
    largest = std::max(largest, restore_sh(quantise_sh(scale, scale, steps), scale, steps));
  }
  return largest;
}

MeanGrid grid_of(const std::vector<GaussianWords>& words) {
  if (words.empty()) return {};
  Vec3f least = words.front().mean, greatest = least;
  for (const GaussianWords& w : words)
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], w.mean[axis]);
      greatest[axis] = std::max(greatest[axis], w.mean[axis]);
    }
  return mean_grid(least, greatest);
}

double position_error(const Chunk& chunk, const ChunkHeader& header) {
  std::vector<GaussianWords> restored = chunk.words;
  for (size_t i = 0; i < restored.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double centre = box_centre(chunk.record_of(i), axis), step = header.position_step[axis];
      float& mean = restored[i].mean[axis];
      mean = restore_position(quantise_position(mean, centre, step), centre, step);
    }
  const MeanGrid grid = grid_of(restored);
  double most = 0;
  for (size_t i = 0; i < restored.size(); ++i) {
    const Vec3f mean = restored_mean(mean_code(restored[i].mean, grid), grid);
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double off = double{mean[axis]} - chunk.words[i].mean[axis];
      squares += off * off;
    }
    most = std::max(most, squares);
  }
  return std::sqrt(most);
}

uint32_t opacity_word(const GaussianWords& words, bool leaf) {
  return leaf ? quantise_leaf_opacity(words.opacity) : float_to_half(words.opacity);
}

// The planes of the Gaussians in the order of the file.
class PlaneEncoder {
 public:
  PlaneEncoder(const Chunk& chunk, const ChunkHeader& header, const EndGroup& end_group)
      : chunk_(chunk), header_(header), end_group_(end_group) {}

  void put_geometry(GaussianPlanes& planes) const {
    const auto& words = chunk_.words;
    for (int axis = 0; axis < 3; ++axis)
      planes.put(3, [&](size_t i) {
        return quantise_position(words[i].mean[axis], box_centre(chunk_.record_of(i), axis),
                                 header_.position_step[axis]);
      });
    end_group_(planes.position());
    for (int axis = 0; axis < 3; ++axis)
      planes.put(2,
                 [&](size_t i) { return uint32_t{quantise_log_scale(words[i].log_scale[axis])}; });
    end_group_(planes.position());
    for (size_t k = 0; k < 3; ++k)
      planes.put(2, [&](size_t i) { return uint32_t{quantise_rotation(words[i].rotation)[k]}; });
    planes.put(2, [&](size_t i) { return opacity_word(words[i], chunk_.has_logit(i)); });
  }

  void put_sh(GaussianPlanes& planes, size_t coefficients) const {
    const float* sh = chunk_.sh.data();
    const size_t stride = 3 * coefficients;
    for (size_t c = 0; c < 3; ++c)
      planes.put(2, [&](size_t i) { return uint32_t{float_to_half(sh[i * stride + c])}; });
    end_group_(planes.position());
    for (size_t band = 0; band_start(band) < coefficients; ++band) {
      for (size_t k = 3 * band_start(band); k < 3 * band_start(band + 1); ++k)
        planes.put(1, [&](size_t i) {
          return static_cast<uint32_t>(
              quantise_sh(sh[i * stride + k], header_.sh_scale[band], kShSteps[band]));
        });
      const bool more = band_start(band + 1) < coefficients;
      if (!more || kShSteps[band + 1] != kShSteps[band]) end_group_(planes.position());
    }
  }

  void put_sources(GaussianPlanes& planes) const {
    planes.put(4, [&](size_t i) { return chunk_.source_index[i]; });
    planes.put(1, [&](size_t i) { return uint32_t{chunk_.node_code[i]}; });
    end_group_(planes.end());
  }

 private:
  const Chunk& chunk_;
  const ChunkHeader& header_;
  const EndGroup& end_group_;
};

void take_geometry(GaussianPlanes& planes, const ChunkHeader& header, Chunk& chunk) {
  for (int axis = 0; axis < 3; ++axis)
    planes.take(3, [&](size_t i, uint32_t q) {
      chunk.words[i].mean[axis] =
          restore_position(q, box_centre(chunk.record_of(i), axis), header.position_step[axis]);
    });
  for (int axis = 0; axis < 3; ++axis)
    planes.take(2, [&](size_t i, uint32_t q) {
      chunk.words[i].log_scale[axis] = restore_log_scale(static_cast<uint16_t>(q));
    });
  auto& codes = chunk.rotation_code;
  codes.resize(chunk.words.size());
  for (size_t k = 0; k < 3; ++k)
    planes.take(2, [&](size_t i, uint32_t q) { codes[i][k] = static_cast<uint16_t>(q); });
  for (size_t i = 0; i < codes.size(); ++i)
    chunk.words[i].rotation = restore_rotation(codes[i].data());
  planes.take(2, [&](size_t i, uint32_t q) {
    const auto word = static_cast<uint16_t>(q);
    chunk.words[i].opacity = chunk.has_logit(i) ? restore_leaf_opacity(word) : half_to_float(word);
  });
}

// In memory a step has as many bits as its range takes (runtime/math/sh_code.h).
[[noreturn]] void refuse_step(int8_t step, int most, const ChunkLocation& location) {
  location.damaged("an SH step of " + std::to_string(step),
                   std::to_string(-most) + " to " + std::to_string(most));
}

void take_sh(GaussianPlanes& planes, const ChunkHeader& header, size_t coefficients,
             const ChunkLocation& location, Chunk& chunk) {
  const size_t stride = 3 * coefficients;
  float* sh = chunk.sh.data();
  for (size_t c = 0; c < 3; ++c)
    planes.take(2, [&](size_t i, uint32_t q) {
      sh[i * stride + c] = half_to_float(static_cast<uint16_t>(q));
    });
  for (size_t band = 0; band_start(band) < coefficients; ++band) {
    const int most = kShSteps[band];
    std::array<float, 256> restored;  // by step, from -most
    for (int step = -most; step <= most; ++step)
      restored[static_cast<size_t>(step + most)] =
          restore_sh(static_cast<int8_t>(step), header.sh_scale[band], most);
    for (size_t k = 3 * band_start(band); k < 3 * band_start(band + 1); ++k)
      planes.take(1, [&](size_t i, uint32_t q) {
        const auto step = static_cast<int8_t>(q);
        const auto at = static_cast<size_t>(step + most);
        if (at > static_cast<size_t>(2 * most)) refuse_step(step, most, location);
        sh[i * stride + k] = restored[at];
      });
  }
}

}  // namespace

uint64_t compact_plane_bytes(const ChunkEntry& entry, size_t coefficients, uint32_t version) {
  return plane_bytes(entry.record_count, entry.subtree_count, entry.node_count, coefficients,
                     version);
}

void encode_compact(const Chunk& chunk, const ChunkContext& context, ChunkHeader& header,
                    EncodedChunk& out) {
  const size_t coefficients = context.coefficients(), nodes = chunk.words.size();
  for (int axis = 0; axis < 3; ++axis) header.position_step[axis] = position_step(chunk, axis);
  set_sh_scales(chunk, coefficients, header);
  std::vector<std::byte> raw(plane_bytes(chunk.records.size(), chunk.subtrees.size(), nodes,
                                         coefficients, context.version));
  Compressor frame(out.bytes);
  const std::byte *group = raw.data(), *const end = raw.data() + raw.size();
  const EndGroup end_group = [&](const std::byte* position) {
    frame.add(group, position, position == end);
    group = position;
  };
  const ChunkCounts counts = counts_of(chunk);
  const Families families = families_of(counts);
  const GaussianOrder order = gaussian_order(families, counts, chunk.record);
  std::byte* const at = put_records(raw.data(), chunk, counts, families, context, end_group);
  GaussianPlanes planes(at, order, gaussian_bytes(coefficients));
  const PlaneEncoder encoder(chunk, header, end_group);
  encoder.put_geometry(planes);
  encoder.put_sh(planes, coefficients);
  encoder.put_sources(planes);
  out.position_error = position_error(chunk, header);
  out.largest_sh = largest_restored_sh(chunk, coefficients, header);
}

void decode_compact(std::span<const std::byte> payload, const ChunkHeader& header,
                    const ChunkLocation& location, const ChunkContext& context, Chunk& chunk) {
  const ChunkEntry& entry = location.entry;
  const size_t nodes = entry.node_count, coefficients = context.coefficients();
  if (ZSTD_findFrameCompressedSize(payload.data(), payload.size()) != payload.size())
    location.damaged("a payload of something else", "one zstd frame");
  std::vector<std::byte> raw(compact_plane_bytes(entry, coefficients, context.version));
  const size_t got = ZSTD_decompress(raw.data(), raw.size(), payload.data(), payload.size());
  if (ZSTD_isError(got)) location.damaged(ZSTD_getErrorName(got), "a zstd frame");
  if (got != raw.size())
    location.damaged(std::to_string(got) + " bytes in the frame", std::to_string(raw.size()));
  std::byte* at = raw.data();
  const ChunkCounts counts = take_counts(at, entry, context.version);
  const Families families = families_of(counts);
  take_records(at, counts, families, context.extents, chunk);
  link_subtrees(counts.of_subtree, location, context, chunk);
  const GaussianOrder order = gaussian_order(families, counts, chunk.record);
  GaussianPlanes planes(at, order, gaussian_bytes(coefficients));
  chunk.words.resize(nodes);
  take_geometry(planes, header, chunk);
  std::copy_n(header.sh_scale, 3, chunk.sh_scale.begin());
  chunk.sh.resize(nodes * coefficients * 3);
  take_sh(planes, header, coefficients, location, chunk);
  chunk.source_index.resize(nodes);
  planes.take(4, [&](size_t i, uint32_t v) { chunk.source_index[i] = v; });
  chunk.node_code.resize(nodes);
  planes.take(1, [&](size_t i, uint32_t v) { chunk.node_code[i] = static_cast<uint8_t>(v); });
}

void round_means(Chunk& chunk) {
  chunk.mean_grid = grid_of(chunk.words);
  chunk.mean_code.reserve(chunk.words.size());
  for (GaussianWords& w : chunk.words) {
    chunk.mean_code.push_back(mean_code(w.mean, chunk.mean_grid));
    w.mean = restored_mean(chunk.mean_code.back(), chunk.mean_grid);
  }
}

}  // namespace voyager
