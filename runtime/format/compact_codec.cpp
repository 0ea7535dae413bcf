#include "runtime/format/compact_codec.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "runtime/base/error.h"
#include "runtime/format/quantise.h"
#include "runtime/format/record_planes.h"

namespace voyager {
namespace {

constexpr int kLevel = 3;
constexpr size_t kBandStart[4] = {1, 4, 9, 16};  // first coefficient of bands 1, 2, 3, and the end

// Planes of n bytes, filled and read in the order of the file. A value of
// several bytes takes a plane for each, lowest first.
class BytePlanes {
 public:
  BytePlanes(std::byte* bytes, size_t n) : next_(bytes), n_(n) {}

  template <class Value>
  void put(size_t width, const Value& value) {
    for (size_t i = 0; i < n_; ++i) {
      const uint32_t v = value(i);
      for (size_t b = 0; b < width; ++b) next_[b * n_ + i] = static_cast<std::byte>(v >> (8 * b));
    }
    next_ += width * n_;
  }

  template <class Store>
  void take(size_t width, const Store& store) {
    for (size_t i = 0; i < n_; ++i) {
      uint32_t v = 0;
      for (size_t b = 0; b < width; ++b)
        v |= std::to_integer<uint32_t>(next_[b * n_ + i]) << (8 * b);
      store(i, v);
    }
    next_ += width * n_;
  }

  const std::byte* position() const { return next_; }

 private:
  std::byte* next_;
  size_t n_;
};

// One zstd frame; each group of planes ends a block, so that it gets entropy
// tables of its own.
class Compressor {
 public:
  explicit Compressor(std::vector<std::byte>& out)
      : context_(ZSTD_createCCtx(), &ZSTD_freeCCtx), out_(out) {
    if (!context_) throw std::bad_alloc();
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel);
  }

  void add(const std::byte* begin, const std::byte* end, bool last) {
    ZSTD_inBuffer in{begin, static_cast<size_t>(end - begin), 0};
    for (size_t left = 1; left != 0;) {
      const size_t start = out_.size();
      out_.resize(start + ZSTD_CStreamOutSize());
      ZSTD_outBuffer room{out_.data() + start, out_.size() - start, 0};
      left = ZSTD_compressStream2(context_.get(), &room, &in, last ? ZSTD_e_end : ZSTD_e_flush);
      out_.resize(start + room.pos);
      if (ZSTD_isError(left)) throw Error(ErrorCode::internal, ZSTD_getErrorName(left));
    }
  }

 private:
  std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> context_;
  std::vector<std::byte>& out_;
};

void set_position_frame(const Chunk& chunk, ChunkHeader& header) {
  for (int axis = 0; axis < 3; ++axis) {
    double lo = chunk.words[0].mean[axis], hi = lo;
    for (const GaussianWords& w : chunk.words) {
      lo = std::min<double>(lo, w.mean[axis]);
      hi = std::max<double>(hi, w.mean[axis]);
    }
    header.position_min[axis] = lo;
    header.position_step[axis] = (hi - lo) / kPositionSteps;
  }
}

void set_sh_scales(const Chunk& chunk, size_t coefficients, ChunkHeader& header) {
  for (size_t i = 0; i < chunk.records.size(); ++i)
    for (size_t band = 0; band < 3; ++band)
      for (size_t k = 3 * kBandStart[band]; k < 3 * std::min(coefficients, kBandStart[band + 1]);
           ++k)
        header.sh_scale[band] =
            std::max(header.sh_scale[band], std::fabs(chunk.sh[i * coefficients * 3 + k]));
}

double position_error(const Chunk& chunk, const ChunkHeader& header) {
  double most = 0;
  for (const GaussianWords& w : chunk.words) {
    double squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double min = header.position_min[axis], step = header.position_step[axis];
      const double restored =
          restore_position(quantise_position(w.mean[axis], min, step), min, step);
      squares += (restored - w.mean[axis]) * (restored - w.mean[axis]);
    }
    most = std::max(most, squares);
  }
  return std::sqrt(most);
}

uint32_t opacity_word(const GaussianWords& words, bool leaf) {
  return leaf ? quantise_leaf_opacity(words.opacity) : float_to_half(words.opacity);
}

void put_geometry(const Chunk& chunk, const ChunkHeader& header, BytePlanes& planes) {
  for (int axis = 0; axis < 3; ++axis)
    planes.put(3, [&](size_t i) {
      return quantise_position(chunk.words[i].mean[axis], header.position_min[axis],
                               header.position_step[axis]);
    });
  for (int axis = 0; axis < 3; ++axis)
    planes.put(
        2, [&](size_t i) { return uint32_t{quantise_log_scale(chunk.words[i].log_scale[axis])}; });
  for (size_t k = 0; k < 3; ++k)
    planes.put(2,
               [&](size_t i) { return uint32_t{quantise_rotation(chunk.words[i].rotation)[k]}; });
  planes.put(
      2, [&](size_t i) { return opacity_word(chunk.words[i], chunk.records[i].child_count == 0); });
}

void take_geometry(BytePlanes& planes, const ChunkHeader& header, Chunk& chunk) {
  for (int axis = 0; axis < 3; ++axis)
    planes.take(3, [&](size_t i, uint32_t q) {
      chunk.words[i].mean[axis] =
          restore_position(q, header.position_min[axis], header.position_step[axis]);
    });
  for (int axis = 0; axis < 3; ++axis)
    planes.take(2, [&](size_t i, uint32_t q) {
      chunk.words[i].log_scale[axis] = restore_log_scale(static_cast<uint16_t>(q));
    });
  std::vector<std::array<uint16_t, 3>> rotations(chunk.words.size());
  for (size_t k = 0; k < 3; ++k)
    planes.take(2, [&](size_t i, uint32_t q) { rotations[i][k] = static_cast<uint16_t>(q); });
  for (size_t i = 0; i < rotations.size(); ++i)
    chunk.words[i].rotation = restore_rotation(rotations[i]);
  planes.take(2, [&](size_t i, uint32_t q) {
    const uint16_t word = static_cast<uint16_t>(q);
    chunk.words[i].opacity =
        chunk.records[i].child_count == 0 ? restore_leaf_opacity(word) : half_to_float(word);
  });
}

}  // namespace

size_t compact_plane_bytes(size_t nodes, size_t coefficients) {
  const size_t node = sizeof(NodeRecord) + 3 * 3 + 3 * 2 + 3 * 2 + 2 + 3 * 2 +
                      (coefficients - 1) * 3 + sizeof(uint32_t) + sizeof(uint8_t);
  return nodes * node;
}

double encode_compact(const Chunk& chunk, const ChunkContext& context, ChunkHeader& header,
                      std::vector<std::byte>& out) {
  const size_t n = chunk.records.size(), coefficients = context.coefficients();
  set_position_frame(chunk, header);
  set_sh_scales(chunk, coefficients, header);
  std::vector<std::byte> raw(compact_plane_bytes(n, coefficients));
  BytePlanes planes(raw.data(), n);
  Compressor frame(out);
  const std::byte* group = raw.data();
  const auto end_group = [&](bool last) {
    frame.add(group, planes.position(), last);
    group = planes.position();
  };
  for (size_t word = 0; word < 8; ++word) {
    planes.put(4, [&](size_t i) { return to_words(chunk.records[i]).word[word]; });
    end_group(false);
  }
  put_geometry(chunk, header, planes);
  end_group(false);
  const float* sh = chunk.sh.data();
  for (size_t c = 0; c < 3; ++c)
    planes.put(2, [&](size_t i) { return uint32_t{float_to_half(sh[i * coefficients * 3 + c])}; });
  end_group(false);
  for (size_t band = 0; band < static_cast<size_t>(context.sh_degree); ++band) {
    for (size_t k = 3 * kBandStart[band]; k < 3 * kBandStart[band + 1]; ++k)
      planes.put(1, [&](size_t i) {
        return static_cast<uint32_t>(
            quantise_sh(sh[i * coefficients * 3 + k], header.sh_scale[band], kShSteps[band]));
      });
    end_group(false);
  }
  planes.put(4, [&](size_t i) { return chunk.source_index[i]; });
  planes.put(1, [&](size_t i) { return uint32_t{chunk.axis_code[i]}; });
  end_group(true);
  return position_error(chunk, header);
}

void decode_compact(std::span<const std::byte> payload, const ChunkHeader& header,
                    const ChunkPlace& place, const ChunkContext& context, Chunk& chunk) {
  const size_t n = place.node_count, coefficients = context.coefficients();
  std::vector<std::byte> raw(compact_plane_bytes(n, coefficients));
  const size_t got = ZSTD_decompress(raw.data(), raw.size(), payload.data(), payload.size());
  if (ZSTD_isError(got)) place.damaged(ZSTD_getErrorName(got), "a zstd frame");
  if (got != raw.size())
    place.damaged(std::to_string(got) + " bytes in the frame", std::to_string(raw.size()));
  BytePlanes planes(raw.data(), n);
  std::vector<RecordWords> records(n);
  for (size_t word = 0; word < 8; ++word)
    planes.take(4, [&](size_t i, uint32_t v) { records[i].word[word] = v; });
  chunk.records.resize(n);
  std::transform(records.begin(), records.end(), chunk.records.begin(), from_words);
  chunk.words.resize(n);
  take_geometry(planes, header, chunk);
  chunk.sh.resize(n * coefficients * 3);
  float* sh = chunk.sh.data();
  for (size_t c = 0; c < 3; ++c)
    planes.take(2, [&](size_t i, uint32_t q) {
      sh[i * coefficients * 3 + c] = half_to_float(static_cast<uint16_t>(q));
    });
  for (size_t band = 0; band < static_cast<size_t>(context.sh_degree); ++band)
    for (size_t k = 3 * kBandStart[band]; k < 3 * kBandStart[band + 1]; ++k)
      planes.take(1, [&](size_t i, uint32_t q) {
        sh[i * coefficients * 3 + k] =
            restore_sh(static_cast<int8_t>(q), header.sh_scale[band], kShSteps[band]);
      });
  chunk.source_index.resize(n);
  planes.take(4, [&](size_t i, uint32_t v) { chunk.source_index[i] = v; });
  chunk.axis_code.resize(n);
  planes.take(1, [&](size_t i, uint32_t v) { chunk.axis_code[i] = static_cast<uint8_t>(v); });
}

}  // namespace voyager
