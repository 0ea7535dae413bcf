#include "runtime/frame/host_pool.h"

#include <algorithm>

#include "runtime/frame/load.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/select/partitioned.h"
#include "runtime/stream/linker.h"
#include "runtime/stream/search_chunks.h"

namespace voyager {
namespace {

// Whether what a node has of children is in no other array.
bool counts_children(const Scene& scene) {
  return !is_coded(scene) && !scene.search.leaves_have_extent;
}

class HostPool final : public ChunkPool {
 public:
  HostPool(Scene& scene, const std::shared_ptr<const SceneFile>& file, SlotShape shape,
           PoolRoom room)
      : scene_(scene), shape_(shape) {
    scene.search.chunk_of = [file](uint32_t chunk) { return search_chunk(*file, chunk); };
    resize(room);
  }

  void resize(PoolRoom room) override {
    SearchTree& search = scene_.search;
    if (search.subtrees.size() != places_of(room) || scene_.slot_ids.size() != room.slots ||
        search.next_block.size() != room.blocks ||
        scene_.large_families.capacity() != room.families)
      make_room(room);
    scene_.large_families.clear();
    std::fill(search.subtrees.begin(), search.subtrees.end(), kUnlinkedSubtree);
    std::fill(search.pages.begin(), search.pages.end(), 0);
  }

  void fill(std::span<const StagedChunk* const> chunks) override {
    for (const StagedChunk* chunk : chunks) fill(*chunk);
  }

  const BoundsCode& bounds(const CheckedRecord& of) const override {
    return scene_.search.records[of.record].code;
  }

  void apply(const LinkPatch& patch) override {
    SearchTree& search = scene_.search;
    const auto set_records = [&](const std::vector<LinkPatch::Record>& records) {
      for (const LinkPatch::Record& r : records) {
        search.records[r.record].children = r.children;
      }
    };
    set_records(patch.cut.records);
    for (const uint32_t s : patch.unlinked) search.subtrees[search.places()(s)].entry = kNotLinked;
    for (const PageChange& change : patch.pages) {
      search.pages[change.page] = change.place;
      if (change.place != 0)
        std::fill_n(search.subtrees.begin() + size_t{change.place} * kPageSubtrees, kPageSubtrees,
                    kUnlinkedSubtree);
    }
    set_records(patch.tied.records);
    for (const auto& [s, linked] : patch.linked) search.subtrees[search.places()(s)] = linked;
    for (const LinkPatch::Outside& o : patch.outside)
      scene_.root_parents[search.places()(o.subtree)] = o.parent;
    if (patch.large) scene_.large_families.assign(patch.large->begin(), patch.large->end());
  }

 private:
  void fill(const StagedChunk& staged) {
    const Chunk& chunk = staged.content;
    const uint32_t slot = staged.links.slot;
    const size_t base = size_t{slot} * shape_.nodes;
    scene_.slot_ids[slot] = staged.ids;
    if (is_coded(scene_)) {
      scene_.sh_scales[slot] = chunk.sh_scale;
      scene_.mean_grids[slot] = chunk.mean_grid;
    }
    for (size_t i = 0; i < chunk.node.size(); ++i) {
      const size_t at = base + staged.place[i];
      set_gaussian(chunk, i, at, scene_);
      if (scene_.search.leaves_have_extent) scene_.tree.records[at] = chunk.record_of(i);
      if (counts_children(scene_)) scene_.child_count[at] = chunk.record_of(i).child_count;
    }
    for (uint32_t i = 0; i < staged.records.size(); ++i)
      scene_.search.records[staged.record(i)] = staged.records[i];
    const std::vector<uint32_t>& blocks = staged.blocks;
    for (size_t i = 1; i < blocks.size(); ++i) scene_.search.next_block[blocks[i - 1]] = blocks[i];
  }

  // Beside the first page, which is that of all that have none.
  static size_t places_of(PoolRoom room) { return (size_t{room.pages} + 1) * kPageSubtrees; }

  // The old arrays go first, so that a budget holds at every moment.
  void make_room(PoolRoom room_for) {
    scene_.slot_nodes = shape_.nodes;
    const size_t slots = room_for.slots, nodes = slots * shape_.nodes;
    for (const bool room : {false, true}) {
      const auto fit = [room](auto& array, size_t size) {
        std::decay_t<decltype(array)>(room ? size : 0, array.get_allocator()).swap(array);
      };
      make_gaussian_room(room ? nodes : 0, room ? slots : 0, scene_);
      fit(scene_.tree.records, scene_.search.leaves_have_extent ? nodes : 0);
      fit(scene_.child_count, counts_children(scene_) ? nodes : 0);
      fit(scene_.slot_ids, slots);
      fit(scene_.search.subtrees, places_of(room_for));
      fit(scene_.root_parents, places_of(room_for));
      fit(scene_.search.pages, pages_of(scene_.search.subtree_count()));
      fit(scene_.search.records, size_t{room_for.blocks} * kRecordBlock);
      fit(scene_.search.next_block, room_for.blocks);
      fit(scene_.large_families, 0);
    }
    scene_.large_families.reserve(room_for.families);
  }

  Scene& scene_;
  const SlotShape shape_;
};

}  // namespace

namespace {

PoolBytes pool_bytes(const Scene& scene, SlotShape shape) {
  const uint64_t node = gaussian_bytes(scene.storage, scene.sh_degree) +
                        (counts_children(scene) ? sizeof(uint32_t) : 0) +
                        (scene.search.leaves_have_extent ? sizeof(NodeRecord) : 0);
  const uint64_t block = kRecordBlock * sizeof(SearchRecord) + sizeof(uint32_t);
  const uint64_t page = kPageSubtrees * (sizeof(SearchSubtree) + sizeof(uint32_t));
  const SearchTree& search = scene.search;
  const uint64_t scales = is_coded(scene) ? sizeof(ShScales) + sizeof(MeanGrid) : 0;
  return {shape.nodes * node + scales + sizeof(SlotIds), block,
          page + pages_of(search.subtree_count()) * sizeof(uint32_t) +
              search.tier_begin.size() * sizeof(uint32_t),
          page, sizeof(LargeFamily)};
}

PoolBytes view_bytes(const SearchTree& tree) {
  const uint64_t page = kPageSubtrees * PartitionedSearch::kPlaceBytes;
  return {0, 0, PartitionedSearch::fixed_bytes(tree) + page, page};
}

}  // namespace

RoomBytes host_room_bytes(const Scene& scene, SlotShape shape) {
  const PoolBytes links = Linker::bytes(shape);
  return {pool_bytes(scene, shape) + links, view_bytes(scene.search), {}};
}

std::unique_ptr<ChunkPool> create_host_pool(Scene& scene,
                                            const std::shared_ptr<const SceneFile>& file,
                                            SlotShape shape, PoolRoom room) {
  return std::make_unique<HostPool>(scene, file, shape, room);
}

std::unique_ptr<ChunkPool> Backend::create_pool(Scene& scene,
                                                const std::shared_ptr<const SceneFile>& file,
                                                SlotShape shape, PoolRoom room) {
  return create_host_pool(scene, file, shape, room);
}

RoomBytes Backend::room_bytes(const Scene& scene, SlotShape shape) const {
  return host_room_bytes(scene, shape);
}

}  // namespace voyager
