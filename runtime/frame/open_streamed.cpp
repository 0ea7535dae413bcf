#include "runtime/frame/open_streamed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/frame/load.h"

namespace voyager {
namespace {

// All that is known without a chunk; the pool has the rest.
void set_search(const SceneFile& file, SearchTree& search) {
  search.chunks_come_and_go = true;
  search.leaves_have_extent = file.info().leaves_have_extent;
  const Tiers tiers = file.tiers();
  search.chunk_count = file.info().chunk_count;
  search.tier_begin.assign(tiers.tier_begin.begin(), tiers.tier_begin.end());
}

// Each goes through the whole directory, which is much of the time that opening takes.
void find_records_and_graph(const SceneFile& file, StreamDesc& desc, Workers& workers) {
  workers.for_blocks(2, 1, [&](size_t which, size_t) {
    if (which == 0)
      desc.records.emplace(file);
    else
      desc.graph = std::make_shared<const ChunkGraph>(file.chunks(), file.tiers());
  });
}

// Before they are read it is not known how many blocks they take.
uint32_t first_of(const SceneFile& file, const StreamDesc& desc, uint64_t limit) {
  uint64_t bytes = 0, blocks = 0;
  uint32_t first = 0;
  for (; first < desc.room.slots; ++first) {
    bytes += file.chunks()[first].bytes;
    blocks += desc.records->most_blocks(first);
    if (bytes > limit || blocks > desc.room.blocks) break;
  }
  return std::max(first, desc.pinned);
}

}  // namespace

std::shared_ptr<Scene> open_streamed(const std::shared_ptr<const ByteSource>& source,
                                     const StreamingDesc& desc, Backend& backend,
                                     std::pmr::memory_resource* memory, Workers& workers) {
  std::array<std::byte, 8> first{};
  const auto start = std::span(first).first(std::min<uint64_t>(first.size(), source->size()));
  source->read(0, start);
  if (!SceneFile::is_scene_file(start)) return load_scene(source, memory, workers);
  const auto file = std::make_shared<const SceneFile>(source);
  auto scene = std::make_shared<Scene>(memory);
  scene->name = source->name();
  set_info(file->info(), *scene);
  add_notes(*scene);
  if (file->chunks().empty()) return scene;
  set_search(*file, scene->search);
  const SlotShape shape = SceneStream::slot_shape(*file);
  StreamDesc stream;
  stream.bytes = backend.room_bytes(*scene, shape);
  stream.budget = desc.budget;
  find_records_and_graph(*file, stream, workers);
  stream.room = fit_room(*file, *stream.records, stream.bytes, stream.budget, 0);
  stream.pinned = SceneStream::pinned_chunks(*file, stream.room.slots);
  stream.first = desc.start ? stream.pinned : first_of(*file, stream, desc.first_bytes);
  stream.readers = desc.readers;
  stream.clock = desc.clock;
  stream.count = desc.count;
  if (stream.count) stream.count(stream.bytes.of(stream.room));
  scene->pool = backend.create_pool(*scene, file, shape, stream.room);
  scene->stream = std::make_unique<SceneStream>(file, stream, *scene->pool);
  scene->stream->read_top(workers);
  if (desc.start)
    scene->stream->read_around(cut_centre(*desc.start, scene->origin), desc.start_bytes);
  return scene;
}

}  // namespace voyager
