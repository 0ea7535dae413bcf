#include "runtime/frame/open_streamed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/megabytes.h"
#include "runtime/format/check_claims.h"
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

// All slots have room for the largest chunk. A file whose other chunks are far smaller would ask
// for memory of which next to nothing is ever used: no bake makes one that takes more than this.
uint64_t most_bytes(const SceneFile& file) {
  constexpr uint64_t kAnyScene = 16 << 20;
  return kAnyScene + 2 * claimed_bytes(file);
}

// The most that fits.
PoolRoom room_for(const SceneFile& file, const PoolBytes& bytes, uint64_t wanted) {
  const RecordRoom records(file);
  const uint64_t most = most_bytes(file), budget = wanted == 0 ? most : std::min(wanted, most);
  uint32_t fits = SceneStream::top_chunks(file);
  if (const uint64_t least = bytes.of(records.of(fits)); least > budget)
    throw Error(ErrorCode::over_budget, file.name() + ": the top of the tree takes " +
                                            megabytes_text(least) + ", the memory budget allows " +
                                            megabytes_text(budget));
  auto last = static_cast<uint32_t>(file.chunks().size());
  while (fits < last) {
    const uint32_t middle = last - (last - fits) / 2;
    if (bytes.of(records.of(middle)) <= budget)
      fits = middle;
    else
      last = middle - 1;
  }
  return records.of(fits);
}

// Before they are read it is not known how many blocks they take.
uint32_t first_of(const SceneFile& file, const StreamDesc& desc, uint64_t limit) {
  const RecordRoom records(file);
  uint64_t bytes = 0, blocks = 0;
  uint32_t first = 0;
  for (; first < desc.room.slots; ++first) {
    bytes += file.chunks()[first].bytes;
    blocks += records.most_blocks(first);
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
  const PoolBytes bytes = backend.pool_bytes(*scene, shape);
  StreamDesc stream;
  stream.room = room_for(*file, bytes, desc.budget);
  stream.pinned = SceneStream::pinned_chunks(*file, stream.room.slots);
  stream.first = desc.start ? stream.pinned : first_of(*file, stream, desc.first_bytes);
  stream.readers = desc.readers;
  stream.bytes = bytes;
  stream.clock = desc.clock;
  scene->pool = backend.create_pool(*scene, file, shape, stream.room);
  scene->stream = std::make_unique<SceneStream>(file, stream, *scene->pool);
  scene->stream->read_top(workers);
  if (desc.start)
    scene->stream->read_around(cut_centre(*desc.start, scene->origin), desc.start_bytes);
  return scene;
}

void resize_streamed(Scene& scene, uint64_t budget, Backend& backend, Workers& workers) {
  const SceneFile& file = scene.stream->file();
  const PoolBytes bytes = backend.pool_bytes(scene, SceneStream::slot_shape(file));
  const PoolRoom room = room_for(file, bytes, budget);
  scene.stream->resize(room, SceneStream::pinned_chunks(file, room.slots), workers);
}

}  // namespace voyager
