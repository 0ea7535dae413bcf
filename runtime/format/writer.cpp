#include "runtime/format/writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/format/chunk_codec.h"

namespace voyager {
namespace {

// Chunks encoded at a time: enough for every thread, little in memory.
constexpr size_t kBatch = 32;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

Vec3d to_vec(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// Nodes [first, last) as the codec takes them.
Chunk gather(const BakedScene& baked, const ChunkContext& context, uint32_t first, uint32_t last,
             uint32_t first_child) {
  Chunk chunk;
  chunk.first_node = first;
  chunk.first_child = first_child;
  const size_t floats = context.coefficients() * 3;
  chunk.records.assign(baked.tree.records.begin() + first, baked.tree.records.begin() + last);
  chunk.axis_code.assign(baked.axis_code.begin() + first, baked.axis_code.begin() + last);
  for (uint32_t node = first; node < last; ++node) {
    const bool leaf = baked.tree.is_leaf(node);
    const GaussianCloud& cloud = leaf ? baked.leaves : baked.merged;
    const uint32_t index = baked.gaussian[node];
    const GaussianWords words = cloud.words(index);
    chunk.position_words.insert(chunk.position_words.end(),
                                {words.mean.x, words.mean.y, words.mean.z});
    chunk.words.push_back(leaf ? leaf_words(baked, index) : words);
    const float* sh = cloud.sh.data() + index * floats;
    chunk.sh.insert(chunk.sh.end(), sh, sh + floats);
    chunk.source_index.push_back(leaf ? index : kNoNode);
  }
  return chunk;
}

// The first child of each chunk: one more than the children of all nodes before it.
std::vector<uint32_t> first_children(const LodTree& tree, size_t chunks) {
  std::vector<uint32_t> first(chunks);
  uint32_t next = 1;
  for (size_t node = 0; node < tree.size(); ++node) {
    if (node % kChunkNodes == 0) first[node / kChunkNodes] = next;
    next += tree.records[node].child_count;
  }
  return first;
}

uint32_t depth_of(const LodTree& tree) {
  // The last node of a breadth-first order is one of the deepest.
  uint32_t depth = 0;
  for (size_t node = tree.size(); node != 0; ++depth) {
    const uint32_t parent = tree.parent[node - 1];
    node = parent == kNoNode ? 0 : size_t{parent} + 1;
  }
  return depth;
}

FileHeader make_header(const BakedScene& baked, Quality quality, size_t chunks) {
  FileHeader h{};
  std::memcpy(h.magic, kSceneMagic, sizeof h.magic);
  h.version = kSceneVersion;
  h.flags = baked.leaves.antialiased ? kFlagAntialiased : 0;
  h.quality = static_cast<uint32_t>(quality);
  h.sh_degree = static_cast<uint32_t>(baked.leaves.sh_degree);
  h.node_count = static_cast<uint32_t>(baked.tree.size());
  h.leaf_count = static_cast<uint32_t>(baked.leaves.size());
  h.chunk_count = static_cast<uint32_t>(chunks);
  h.depth = depth_of(baked.tree);
  for (size_t axis = 0; axis < 3; ++axis) {
    h.origin[axis] = baked.origin[axis];
    h.source_origin[axis] = baked.leaves.origin[axis];
    if (baked.tree.size() == 0) continue;
    h.bounds_min[axis] = baked.tree.records[0].box_min[static_cast<int>(axis)];
    h.bounds_max[axis] = baked.tree.records[0].box_max[static_cast<int>(axis)];
  }
  const ImportReport& report = baked.leaves.report;
  h.import_read = report.read;
  h.dropped_position = report.dropped_position;
  h.dropped_scale = report.dropped_scale;
  h.repaired_scale = report.repaired_scale;
  h.repaired_rotation = report.repaired_rotation;
  h.repaired_opacity = report.repaired_opacity;
  h.dropped_opacity = report.dropped_opacity;
  h.repaired_sh = report.repaired_sh;
  return h;
}

void finish_file(AtomicFile& file, FileHeader& header, const std::vector<ChunkEntry>& entries) {
  std::vector<std::byte> directory(chunks_start(entries.size()) - sizeof(FileHeader));
  if (!entries.empty())
    std::memcpy(directory.data(), entries.data(), entries.size() * sizeof(ChunkEntry));
  header.file_length = file.position();
  header.section_count = 1;
  header.directory = {static_cast<uint32_t>(SectionKind::chunk_directory), 0, sizeof(FileHeader),
                      directory.size(), checksum(directory)};
  header.checksum = checksum(bytes_of(header).first(offsetof(FileHeader, checksum)));
  file.write_at(0, bytes_of(header));
  file.write_at(sizeof(FileHeader), directory);
  file.commit();
}

}  // namespace

void write_scene_file(const BakedScene& baked, const std::string& path, Quality quality,
                      Workers& workers, const Progress& progress) {
  const size_t nodes = baked.tree.size(), chunks = (nodes + kChunkNodes - 1) / kChunkNodes;
  if (nodes >= kNoNode)
    throw Error(ErrorCode::unsupported,
                path + ": found " + std::to_string(nodes) + " nodes, expected fewer than 2^32 - 1");
  const ChunkContext context{quality, baked.leaves.sh_degree, to_vec(baked.origin),
                             to_vec(baked.leaves.origin),
                             static_cast<uint32_t>(baked.leaves.size())};
  const std::vector<uint32_t> first_child = first_children(baked.tree, chunks);
  FileHeader header = make_header(baked, quality, chunks);
  AtomicFile file(path);
  const std::vector<std::byte> room(chunks_start(chunks));
  file.write(room);
  std::vector<ChunkEntry> entries;
  entries.reserve(chunks);
  for (size_t begin = 0; begin < chunks; begin += kBatch) {
    report(progress, "writing", begin, chunks);
    std::vector<EncodedChunk> batch(std::min(kBatch, chunks - begin));
    workers.for_blocks(batch.size(), 1, [&](size_t i, size_t) {
      const size_t first = (begin + i) * kChunkNodes, last = std::min(nodes, first + kChunkNodes);
      batch[i] = encode_chunk(gather(baked, context, static_cast<uint32_t>(first),
                                     static_cast<uint32_t>(last), first_child[begin + i]),
                              context);
    });
    for (const EncodedChunk& chunk : batch) {
      const size_t first = entries.size() * kChunkNodes;
      entries.push_back({file.position(), static_cast<uint32_t>(chunk.bytes.size()),
                         static_cast<uint32_t>(first),
                         static_cast<uint32_t>(std::min<size_t>(nodes - first, kChunkNodes)),
                         first_child[entries.size()], chunk.checksum});
      file.write(chunk.bytes);
      header.position_error = std::max(header.position_error, chunk.position_error);
    }
  }
  finish_file(file, header, entries);
  report(progress, "writing", chunks, chunks);
}

}  // namespace voyager
