// PlayCanvas' .compressed.ply: an element of chunks, one of vertices, one of SH bands.
#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/compressed_ply_chunk.h"
#include "runtime/scene/export/morton_order.h"
#include "runtime/scene/export/ply_comment.h"
#include "runtime/scene/export/writer.h"

namespace voyager {
namespace {

using namespace compressed_ply;

static_assert(std::endian::native == std::endian::little,
              "words are written as they lie in memory");

// Gaussians that are ordered together, 62 MB as words of SH degree 3: of more, chunks would be
// smaller, and so would the error of positions.
constexpr size_t kOrderedTogether = size_t{1} << 18;
static_assert(kOrderedTogether % kChunkGaussians == 0);

uint64_t chunks_of(uint64_t gaussians) {
  return gaussians / kChunkGaussians + (gaussians % kChunkGaussians != 0 ? 1 : 0);
}

size_t sh_bytes(int sh_degree) {
  return static_cast<size_t>(sh_coefficients(sh_degree) - 1) * 3;
}

std::string compressed_header(uint64_t count, int sh_degree, const NativeScale& native) {
  std::string text = std::string("ply\nformat binary_little_endian 1.0\n") + filter_comment(native);
  const auto element = [&](const std::string& name, uint64_t rows) {
    text += "element " + name + " " + std::to_string(rows) + "\n";
  };
  const auto property = [&](const std::string& type, const std::string& name) {
    text += "property " + type + " " + name + "\n";
  };
  element("chunk", chunks_of(count));
  for (const char* kind : {"", "scale_"})
    for (const char* end : {"min_", "max_"})
      for (const char* axis : {"x", "y", "z"}) property("float", std::string(end) + kind + axis);
  for (const char* end : {"min_", "max_"})
    for (const char* channel : {"r", "g", "b"}) property("float", std::string(end) + channel);
  element("vertex", count);
  for (const char* name : {"position", "rotation", "scale", "color"})
    property("uint", std::string("packed_") + name);
  if (sh_degree > 0) {
    element("sh", count);
    for (size_t i = 0; i < sh_bytes(sh_degree); ++i)
      property("uchar", "f_rest_" + std::to_string(i));
  }
  return text + "end_header\n";
}

class CompressedPlyWriter final : public GaussianWriter {
 public:
  CompressedPlyWriter(PlacedSink& sink, uint64_t count, int sh_degree, const NativeScale& native)
      : sink_(sink), check_(count, sh_degree) {
    check_sh_degree(sh_degree);
    const std::string text = compressed_header(count, sh_degree, native);
    sink_.write(std::as_bytes(std::span(text)));
    chunks_at_ = text.size();
    vertices_at_ = chunks_at_ + chunks_of(count) * sizeof(Bounds);
    sh_at_ = vertices_at_ + count * sizeof(Vertex);
    held_.sh_degree = sh_degree;
  }

  void append(const GaussianCloud& batch) override {
    check_.accept_of_one_origin(batch);
    held_.origin = check_.origin();
    for (size_t first = 0; first < batch.size();) {
      const size_t count = std::min(batch.size() - first, kOrderedTogether - held_.size());
      hold(batch, first, count);
      first += count;
      if (held_.size() == kOrderedTogether) write_held();
    }
  }

  void finish() override {
    check_.finish();
    write_held();
  }

 private:
  void hold(const GaussianCloud& batch, size_t first, size_t count) {
    const auto copy = [&](const auto& from, auto& to, size_t width) {
      const float* begin = from.data() + first * width;
      to.insert(to.end(), begin, begin + count * width);
    };
    copy(batch.position, held_.position, 3);
    copy(batch.log_scale, held_.log_scale, 3);
    copy(batch.rotation, held_.rotation, 4);
    copy(batch.opacity, held_.opacity, 1);
    copy(batch.sh, held_.sh, static_cast<size_t>(batch.coefficients()) * 3);
  }

  void write_held() {
    const std::vector<uint32_t> order = morton_order(held_.position);
    std::vector<Bounds> bounds;
    std::vector<Vertex> vertices;
    for (size_t first = 0; first < order.size(); first += kChunkGaussians) {
      const size_t count = std::min(kChunkGaussians, order.size() - first);
      const Chunk chunk = encode_chunk(held_, std::span(order).subspan(first, count));
      bounds.push_back(chunk.bounds);
      vertices.insert(vertices.end(), chunk.vertices.begin(), chunk.vertices.end());
    }
    put(chunks_at_, std::as_bytes(std::span(bounds)));
    put(vertices_at_, std::as_bytes(std::span(vertices)));
    write_sh(order);
    for (auto* words :
         {&held_.position, &held_.log_scale, &held_.rotation, &held_.opacity, &held_.sh})
      words->clear();
  }

  // Channel after channel, as a .ply has them.
  void write_sh(const std::vector<uint32_t>& order) {
    const auto coefficients = static_cast<size_t>(held_.coefficients());
    std::vector<uint8_t> codes;
    codes.reserve(order.size() * sh_bytes(held_.sh_degree));
    for (const uint32_t i : order)
      for (size_t channel = 0; channel < 3; ++channel)
        for (size_t k = 1; k < coefficients; ++k)
          codes.push_back(sh_code(held_.sh[(i * coefficients + k) * 3 + channel]));
    put(sh_at_, std::as_bytes(std::span(codes)));
  }

  void put(uint64_t& at, std::span<const std::byte> bytes) {
    sink_.write_at(at, bytes);
    at += bytes.size();
  }

  PlacedSink& sink_;
  BatchCheck check_;
  uint64_t chunks_at_, vertices_at_, sh_at_;  // where the next of each go
  GaussianCloud held_;
};

}  // namespace

uint64_t compressed_ply_bytes(uint64_t count, int sh_degree) {
  return chunks_of(count) * sizeof(Bounds) + count * (sizeof(Vertex) + sh_bytes(sh_degree));
}

std::unique_ptr<GaussianWriter> write_compressed_ply(PlacedSink& sink, uint64_t count,
                                                     int sh_degree, const NativeScale& native) {
  return std::make_unique<CompressedPlyWriter>(sink, count, sh_degree, native);
}

}  // namespace voyager
