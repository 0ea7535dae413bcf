#pragma once
// The cut of a scene and its weights, found on the host.
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include "runtime/frame/scene.h"
#include "runtime/frame/scene_search.h"
#include "runtime/frame/weigh_cut.h"
#include "runtime/select/partitioned.h"
#include "runtime/stages/interpolate.h"
#include "runtime/stream/pool_share.h"

namespace voyager {

// Not thread-safe. Scratch, from the given resource, is that of the search that it
// runs, and 16 bytes a node of the largest cut. Of a streamed scene the search's state comes from
// the scene's resource, and is part of the scene's budget.
class HostSearch final : public PoolReaderState {
 public:
  // Throws Error(unsupported) for what check_detail() refuses, and for the exhaustive search of a
  // streamed scene; as PoolShare does. A baseline's tree is made by the workers given.
  HostSearch(std::shared_ptr<const Scene> scene, const SearchDesc& desc,
             std::pmr::memory_resource* memory, Workers& workers);

  // Throws Error(damaged_chunk) where the cut needs a node that is not there, and
  // std::bad_alloc; the next run is right all the same.
  void run(const CutQuery& query, Workers& workers);

  // Of the last run, in the order of node ids, where weights are wanted.
  const std::pmr::vector<DrawItem>& items() const { return items_; }
  // Node ids, ascending.
  void read_cut(std::pmr::vector<uint32_t>& nodes) const;
  const SearchTimes& times() const { return times_; }
  // An exhaustive search keeps nothing to count what entered and left: 0.
  SearchStats stats() const;
  bool counts_changes() const { return partitioned_.has_value(); }
  void drop() noexcept override;

 private:
  void follow_stream();
  void find(const CutQuery& query, Workers& workers);
  void weigh(const CutQuery& query, Workers& workers);
  [[noreturn]] void refuse_damaged() const;
  NodeLinks links() const;
  const SearchTree& search_tree() const { return detail_ ? detail_->search : scene_->search; }

  std::shared_ptr<const Scene> scene_;
  SearchDesc desc_;
  std::vector<MissingNodes> missing_;
  std::optional<DetailTree> detail_;      // of a baseline, in the place of the scene's own
  std::shared_ptr<const LodTree> whole_;  // what an exhaustive search reads
  std::optional<ExhaustiveSearch> exhaustive_;
  std::optional<PartitionedSearch> partitioned_;
  std::pmr::vector<DrawItem> items_;
  std::optional<CutQuery> weighed_;  // what items_ are of
  // Of a streamed scene: what the search has heard of.
  uint64_t version_ = 0;
  std::vector<std::shared_ptr<const StreamChange>> changes_;
  SearchTimes times_;
  std::optional<PoolShare> share_;  // last: what goes first frees the state
};

// HostSearch as a SceneSearch: what the backends of the host give out.
std::unique_ptr<SceneSearch> create_host_search(std::shared_ptr<const Scene> scene,
                                                const SearchDesc& desc,
                                                std::pmr::memory_resource* memory,
                                                Workers& workers);

}  // namespace voyager
