#include "runtime/format/lossless_codec.h"

#include <bit>
#include <cstring>

#include "runtime/format/planes.h"

namespace voyager {
namespace {

// The same operations as local_mean() in runtime/lod/baked_scene.h, which has a
// cloud where a chunk has only words.
Vec3f scene_local(const Vec3f& word, const ChunkContext& context) {
  Vec3f mean{};
  for (int axis = 0; axis < 3; ++axis)
    mean[axis] = static_cast<float>((double{word[axis]} + context.source_origin[axis]) -
                                    context.origin[axis]);
  return mean;
}

// Turns the words that a chunk was read with into means, and keeps the words
// where a bit of them differs.
void place_leaves(const ChunkContext& context, Chunk& chunk) {
  std::vector<float> words;
  words.reserve(chunk.words.size() * 3);
  bool differ = false;
  for (size_t i = 0; i < chunk.words.size(); ++i) {
    Vec3f& mean = chunk.words[i].mean;
    const Vec3f word = mean;
    words.insert(words.end(), {word.x, word.y, word.z});
    if (chunk.records[i].child_count == 0) mean = scene_local(word, context);
    for (int axis = 0; axis < 3; ++axis)
      differ |= std::bit_cast<uint32_t>(mean[axis]) != std::bit_cast<uint32_t>(word[axis]);
  }
  if (differ) chunk.position_words = std::move(words);
}

}  // namespace

size_t lossless_payload_bytes(size_t nodes, size_t coefficients) {
  const size_t node = sizeof(NodeRecord) + sizeof(GaussianWords) +
                      coefficients * 3 * sizeof(float) + sizeof(uint32_t) + sizeof(uint8_t);
  return nodes * node;
}

void encode_lossless(const Chunk& chunk, std::vector<std::byte>& out) {
  PlaneWriter planes(out);
  planes.put(chunk.records.data(), chunk.records.size());
  if (chunk.position_words.empty())
    for (const GaussianWords& w : chunk.words) planes.put(&w.mean, 1);
  else
    planes.put(chunk.position_words.data(), chunk.position_words.size());
  for (const GaussianWords& w : chunk.words) planes.put(&w.log_scale, 1);
  for (const GaussianWords& w : chunk.words) planes.put(&w.rotation, 1);
  for (const GaussianWords& w : chunk.words) planes.put(&w.opacity, 1);
  planes.put(chunk.sh.data(), chunk.sh.size());
  planes.put(chunk.source_index.data(), chunk.source_index.size());
  planes.put(chunk.axis_code.data(), chunk.axis_code.size());
}

void decode_lossless(std::span<const std::byte> payload, size_t nodes, const ChunkContext& context,
                     Chunk& chunk) {
  PlaneReader planes(payload);
  chunk.records.resize(nodes);
  planes.take(chunk.records.data(), nodes);
  chunk.words.resize(nodes);
  for (GaussianWords& w : chunk.words) planes.take(&w.mean, 1);
  for (GaussianWords& w : chunk.words) planes.take(&w.log_scale, 1);
  for (GaussianWords& w : chunk.words) planes.take(&w.rotation, 1);
  for (GaussianWords& w : chunk.words) planes.take(&w.opacity, 1);
  chunk.sh.resize(nodes * context.coefficients() * 3);
  planes.take(chunk.sh.data(), chunk.sh.size());
  chunk.source_index.resize(nodes);
  planes.take(chunk.source_index.data(), nodes);
  chunk.axis_code.resize(nodes);
  planes.take(chunk.axis_code.data(), nodes);
  place_leaves(context, chunk);
}

}  // namespace voyager
