#pragma once
// One view's search of one scene on the device. What it launches waits for no host.
#include <cuda_runtime_api.h>

#include <memory>

#include "cuda/device/device.h"
#include "cuda/scene/device_tree.h"
#include "cuda/scene/gaussian_view.h"
#include "cuda/scene/sweep_tree.h"
#include "cuda/search/row_places.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/scene_search.h"
#include "runtime/select/node_owners.h"
#include "runtime/select/visit.h"
#include "runtime/stages/reach.h"

namespace voyager::cuda {

// A cut on the device. Places that hold kNoNode are none.
struct CutList {
  const uint32_t* nodes;  // in the order of ids: ids, or addresses of a streamed scene
  // t by place. Null where there are none, or where they are found as the list is drawn.
  const float* weights;
  const uint32_t* size;  // places in use; on the device, as the arrays are
  uint32_t room;         // no list has more places
  // By row: of its nodes and of their parents. Null where the search keeps none.
  const MeanBounds* bounds = nullptr;
};

// Some rows of a list, in any order; on the device. Null: all of them.
struct RowList {
  const uint32_t* rows = nullptr;
  const uint32_t* count = nullptr;
};

// What the weights of a cut list are found from, by who draws it (cut_weight.cuh): from the
// subtrees that own its nodes. Where neither says which these are the list has its weights.
struct WeightSource {
  NodeOwners owners{};
  PoolNodes nodes{};  // of a pool
  TreeView tree{};
  Sight sight{};

  VOYAGER_HD bool weighs() const { return owners.runs != nullptr || nodes.owners != nullptr; }
  VOYAGER_HD uint32_t owner(uint32_t node) const {
    return owners.runs != nullptr ? owners(node) : nodes.owner(node);
  }
};

struct CutFound {
  SearchStats stats;
  uint32_t cut_size;  // nodes
};

// Keeps its cut from run to run. Not thread-safe; one stream at a time.
class CutSearch {
 public:
  virtual ~CutSearch() = default;
  virtual void find(const CutQuery& query, cudaStream_t stream) = 0;
  // The bounds of the rows that the last find() wrote, where the search keeps them.
  virtual void bound(const GaussianView&, cudaStream_t) {}
  // t of the cut just found, for list() and read(); only of a search that was made for weights.
  virtual void weigh(const CutQuery& query, cudaStream_t stream) = 0;
  // What weighs the cut while it is drawn, in place of weigh(), and needs no memory for it. None:
  // call weigh().
  virtual WeightSource weight_source(const CutQuery&) const { return {}; }
  virtual CutList list() const = 0;
  // What reads the scene's arrays in this frame has been launched, or has failed to be.
  virtual void end_frame(cudaStream_t) noexcept {}

  // What found() needs of the last run: report_bytes() in pinned memory, copied on the stream.
  virtual size_t report_bytes() const = 0;
  virtual void report(void* into, cudaStream_t stream) const = 0;
  virtual CutFound found(const void* report) const = 0;
  virtual bool counts_changes() const = 0;
  // Of the last run; the stream has come to its end.
  virtual void read(std::vector<uint32_t>& cut, std::vector<float>& weights) = 0;
};

// Arrays of a scene that searches share.
std::shared_ptr<const DeviceTree> upload_tree(const Scene& scene);

// kind: any but exhaustive; temporal in place of a sweep. Device memory besides the scene's arrays:
// 27 bytes a subtree and, for the list, at most 6.3 a leaf. What the search of a
// streamed scene takes is part of the scene's budget, by with_view(). It runs under
// SceneStream::hold(), and ends each run with end_frame().
std::unique_ptr<CutSearch> create_partitioned_search(std::shared_ptr<const Device> device,
                                                     std::shared_ptr<const DeviceTree> tree,
                                                     std::shared_ptr<const Scene> scene,
                                                     Search kind, bool weights, Workers& workers);
// What each takes of a streamed scene beside the pool, and of how large a cut it has room for.
RoomBytes with_view(const PoolBytes& pool, const Scene& scene, SlotShape shape);

// Uploads every node's record and parent for itself: it is a baseline, not what a frame uses.
// tree: the scene's own, or a DetailTree's; not kept.
// Throws Error(unsupported) for a streamed scene.
std::unique_ptr<CutSearch> create_exhaustive_search(std::shared_ptr<const Device> device,
                                                    const Scene& scene, const LodTree& tree,
                                                    bool weights);

// Of a scene that is resident and undamaged, and whose leaves have no extent. weigh() has nothing
// left to do. Device memory besides the tree's: 4 bytes a node with children, 8 a leaf, and a bit a
// node.
std::unique_ptr<CutSearch> create_sweep_search(std::shared_ptr<const Device> device,
                                               std::shared_ptr<const SweepTree> tree,
                                               const Scene& scene, bool weights);

// Runs on the host, for scenes with damaged chunks; find() throws Error(damaged_chunk)
// where the cut needs one. Three cuts are in flight, in page-locked memory: 8 bytes a node each,
// with half again as much to spare. So find() waits until the device has taken the cut of three
// calls before, and of all of them where a cut has outgrown its memory. Device memory: 8 bytes a
// node of the scene. Throws Error(unsupported) for a streamed scene.
std::unique_ptr<CutSearch> create_host_cut_search(const std::shared_ptr<const Scene>& scene,
                                                  Search kind, Workers& workers);

// A search by itself, on a stream of its own, with its times; made for what desc says.
std::unique_ptr<SceneSearch> create_timed_search(std::shared_ptr<const Device> device,
                                                 std::unique_ptr<CutSearch> search,
                                                 const SearchDesc& desc);

}  // namespace voyager::cuda
