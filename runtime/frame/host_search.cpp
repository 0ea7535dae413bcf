#include "runtime/frame/host_search.h"

#include <algorithm>
#include <utility>

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/frame/weigh_cut.h"
#include "runtime/frame/whole_tree.h"

namespace voyager {

HostSearch::HostSearch(std::shared_ptr<const Scene> scene, const SearchDesc& desc,
                       std::pmr::memory_resource* memory, Workers& workers)
    : scene_(std::move(scene)), desc_(desc), items_(memory) {
  desc_.kind = without_sweep(desc.kind);
  check_detail(*scene_, desc.lod);
  if (scene_->streamed() && desc.kind == Search::exhaustive)
    throw Error(ErrorCode::unsupported,
                "search: found exhaustive for a streamed scene, expected streaming or temporal");
  if (desc.lod != Lod::cut)
    detail_.emplace(
        make_detail_tree(*whole_tree(*scene_), scene_->partition, desc.lod, workers, memory));
  if (desc.kind != Search::exhaustive) {
    auto* const state = scene_->streamed() ? scene_->slot_ids.get_allocator().resource() : memory;
    partitioned_.emplace(search_tree(), memory, state, !desc_.weights);
    if (scene_->streamed()) share_.emplace(*scene_->stream, *this, workers);
    return;
  }
  exhaustive_.emplace(memory);
  whole_ = detail_ ? std::shared_ptr<const LodTree>(std::shared_ptr<void>(), &detail_->tree)
                   : whole_tree(*scene_);
  for (const DamagedNodes& d : scene_->damaged) missing_.push_back({d.first, d.count});
}

void HostSearch::run(const CutQuery& query, Workers& workers) {
  Stopwatch watch;
  const std::optional<CutQuery> weighed = std::exchange(weighed_, std::nullopt);
  if (scene_->streamed()) follow_stream();
  find(query, workers);
  times_.search = watch.lap();
  // A view that stands still has its weights.
  const bool stands = weighed == query && partitioned_ && !partitioned_->relisted();
  if (desc_.weights && !stands) weigh(weights_query(desc_.lod, query), workers);
  weighed_ = query;
  times_.weights = watch.lap();
}

void HostSearch::find(const CutQuery& query, Workers& workers) {
  if (partitioned_)
    partitioned_->run(query, desc_.kind, workers);
  else
    exhaustive_->run(*whole_, missing_, query, workers);
  if ((partitioned_ ? partitioned_->needed_missing() : exhaustive_->needed_missing()) != kNoNode)
    refuse_damaged();
}

void HostSearch::drop() noexcept {
  partitioned_->drop();
}

void HostSearch::follow_stream() {
  const SceneStream& stream = *scene_->stream;
  if (!stream.changes_since(version_, changes_)) partitioned_->forget();
  for (const auto& change : changes_) partitioned_->relink(change->unlinked, change->changed);
  version_ = stream.version();
  changes_.clear();
}

void HostSearch::read_cut(std::pmr::vector<uint32_t>& nodes) const {
  if (desc_.weights) {
    nodes.resize(items_.size());
    std::transform(items_.begin(), items_.end(), nodes.begin(),
                   [](const DrawItem& item) { return item.gaussian; });
  } else {
    nodes = partitioned_ ? partitioned_->cut() : exhaustive_->cut();
  }
  if (!scene_->streamed()) return;
  const uint32_t slot_nodes = scene_->slot_nodes;
  for (uint32_t& node : nodes) node = scene_->slot_ids[node / slot_nodes].id(node % slot_nodes);
}

void HostSearch::weigh(const CutQuery& query, Workers& workers) {
  if (partitioned_) {
    items_.resize(partitioned_->cut_size());
    return weigh_cut(links(), search_tree(), *partitioned_, query, items_, workers);
  }
  const auto& cut = exhaustive_->cut();
  items_.resize(cut.size());
  const WeightParams weights{whole_->records.data(), whole_->parent.data(),
                             exhaustive_->sizes().data(), query.target_size, whole_->blend_share};
  workers.for_blocks(items_.size(), 16384, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) items_[i] = voyager::weigh(weights, cut[i]);
  });
}

NodeLinks HostSearch::links() const {
  if (detail_) return links_of(detail_->tree);
  return node_links(*scene_);
}

void HostSearch::refuse_damaged() const {
  if (partitioned_) {
    const uint32_t subtree = partitioned_->needed_missing_subtree();
    for (const DamagedChunk& d : scene_->damaged_chunks)
      if (subtree >= d.first_subtree && subtree - d.first_subtree < d.subtree_count)
        throw Error(ErrorCode::damaged_chunk, d.message);
    throw Error(ErrorCode::internal,
                "subtree " + std::to_string(subtree) + ": missing, but in no damaged chunk");
  }
  const uint32_t node = exhaustive_->needed_missing();
  for (const DamagedNodes& d : scene_->damaged)
    if (node >= d.first && node - d.first < d.count)
      throw Error(ErrorCode::damaged_chunk, d.message);
  throw Error(ErrorCode::internal,
              "node " + std::to_string(node) + ": missing, but in no damaged chunk");
}

SearchStats HostSearch::stats() const {
  if (partitioned_) return partitioned_->stats();
  SearchStats stats;
  stats.nodes_tested = exhaustive_->nodes_tested();
  stats.bytes_read = stats.nodes_tested * sizeof(NodeRecord);
  return stats;
}

namespace {

class SearchOfHost final : public SceneSearch {
 public:
  SearchOfHost(std::shared_ptr<const Scene> scene, const SearchDesc& desc,
               std::pmr::memory_resource* memory, Workers& workers)
      : search_(std::move(scene), desc, memory, workers), workers_(workers) {}

  void run(const CutQuery& query) override { search_.run(query, workers_); }
  SearchTimes times() override { return search_.times(); }
  SearchStats stats() override { return search_.stats(); }
  void read(std::vector<uint32_t>& cut, std::vector<float>& weights) override {
    std::pmr::vector<uint32_t> nodes;
    search_.read_cut(nodes);
    cut.assign(nodes.begin(), nodes.end());
    weights.clear();
    for (const DrawItem& item : search_.items()) weights.push_back(item.t);
  }

 private:
  HostSearch search_;
  Workers& workers_;
};

}  // namespace

std::unique_ptr<SceneSearch> create_host_search(std::shared_ptr<const Scene> scene,
                                                const SearchDesc& desc,
                                                std::pmr::memory_resource* memory,
                                                Workers& workers) {
  return std::make_unique<SearchOfHost>(std::move(scene), desc, memory, workers);
}

}  // namespace voyager
