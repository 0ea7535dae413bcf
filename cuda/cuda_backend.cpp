#include "cuda/cuda_backend.h"

#include <cuda_runtime_api.h>

#include <algorithm>

#include "cuda/frame/pipeline.h"
#include "cuda/interop/external_ring.h"
#include "cuda/scene/shared_by_scene.h"
#include "cuda/search/search.h"
#include "cuda/splat/baseline.h"
#include "cuda/stream/device_pool.h"
#include "cuda/train/node_trainer.h"
#include "runtime/base/error.h"
#include "runtime/frame/whole_tree.h"

namespace voyager::cuda {
namespace {

int find_device(const uint8_t* uuid) {
  int count = 0;
  check(cudaGetDeviceCount(&count), "devices");
  for (int ordinal = 0; ordinal < count; ++ordinal) {
    cudaDeviceProp properties;
    check(cudaGetDeviceProperties(&properties, ordinal), "device properties");
    if (std::equal(uuid, uuid + 16, reinterpret_cast<const uint8_t*>(properties.uuid.bytes)))
      return ordinal;
  }
  throw Error(ErrorCode::no_device, "CUDA: found " + std::to_string(count) +
                                        " devices, none with the UUID that was asked for");
}

// Nodes up to which a sweep is faster than the temporal search with its weights, on the whole of a
// large GPU and on 16 multiprocessors: bench/NOTES.md, "A sweep".
constexpr size_t kMostSwept = 4'000'000;

class CudaBackend final : public Backend {
 public:
  explicit CudaBackend(const BackendModuleOptions& options)
      : device_(std::make_shared<Device>(
            options.uuid == nullptr ? options.device : find_device(options.uuid),
            options.multiprocessors)) {}

  std::string device_name() const override {
    return device_->name() + ", " + std::to_string(device_->multiprocessors()) + " multiprocessors";
  }
  std::array<uint8_t, 16> device_uuid() const override { return device_->uuid(); }
  DeviceRates rates() const override { return device_->rates(); }
  uint64_t memory_bytes() const override { return device_->memory_bytes(); }
  std::shared_ptr<void> enter() const override { return keep_context(); }
  ExternalSupport external_support() const override { return device_->external_support(); }
  std::unique_ptr<ExternalRing> import_ring(ExternalRingDesc&& desc) const override {
    return cuda::import_ring(device_, std::move(desc));
  }

  std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                            std::pmr::memory_resource*, Workers& workers) override {
    require_exponential_for_truth(desc);
    device_->use();
    MakeInstance make = [this, desc, &workers](const auto& scene) {
      return instance_of(scene, desc, workers);
    };
    if (desc.splatting == Splatting::baseline_3dgs)
      return create_baseline_pipeline(device_, std::move(make), scenes, desc, workers);
    return cuda::create_pipeline(device_, std::move(make), scenes, desc, workers);
  }

  std::unique_ptr<ChunkPool> create_pool(Scene& scene, const std::shared_ptr<const SceneFile>& file,
                                         SlotShape shape, PoolRoom room) override {
    device_->use();
    return std::make_unique<DevicePool>(device_, scene, file, shape, room);
  }
  RoomBytes room_bytes(const Scene& scene, SlotShape shape) const override {
    return with_view(DevicePool::bytes(*device_, scene, shape), scene, shape);
  }

  std::unique_ptr<NodeTrainer> create_trainer(const std::shared_ptr<const Scene>& scene,
                                              Workers&) override {
    return create_node_trainer(device_, scene);
  }

  Search search_for(const Scene& scene, Search asked) const override {
    const bool wanted =
        asked == Search::sweep || (asked == Search::fastest && scene.node_count <= kMostSwept);
    const bool can =
        !scene.streamed() && scene.damaged_chunks.empty() && !scene.search.leaves_have_extent;
    return wanted && can ? Search::sweep : without_sweep(asked);
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc, std::pmr::memory_resource*,
                                             Workers& workers) override {
    device_->use();
    return create_timed_search(device_, cut_search_for(scene, desc, workers), desc);
  }

 private:
  DeviceInstance instance_of(const std::shared_ptr<const Scene>& scene, const PipelineDesc& desc,
                             Workers& workers) {
    auto gaussians = gaussians_.of(scene, [&](const Scene& s) {
      return s.streamed() ? std::make_shared<DeviceScene>(pool_of(s, *device_))
                          : std::make_shared<DeviceScene>(*device_, s, workers);
    });
    const bool searches = !scene->flat() && draws_cut(desc.lod);
    auto search =
        searches ? cut_search_for(scene, {desc.search, true, desc.lod}, workers) : nullptr;
    return {scene, std::move(gaussians), searches ? parents_of(scene) : nullptr,
            create_draws(*scene, desc.lod, std::move(search))};
  }

  // None of a streamed scene: its pool has them.
  std::shared_ptr<const DeviceParents> parents_of(const std::shared_ptr<const Scene>& scene) {
    if (scene->streamed()) return nullptr;
    return parents_.of(scene, [](const Scene& s) { return std::make_shared<DeviceParents>(s); });
  }

  std::unique_ptr<CutSearch> cut_search_for(const std::shared_ptr<const Scene>& scene,
                                            const SearchDesc& desc, Workers& workers) {
    check_detail(*scene, desc.lod);
    if (desc.lod != Lod::cut) return search_of_baseline(scene, desc, workers);
    if (!scene->damaged_chunks.empty()) return create_host_cut_search(scene, desc.kind, workers);
    if (desc.kind == Search::exhaustive)
      return create_exhaustive_search(device_, *scene, *whole_tree(*scene), desc.weights);
    const Search kind = search_for(*scene, desc.kind);
    if (kind == Search::sweep)
      return create_sweep_search(
          device_,
          sweep_trees_.of(
              scene,
              [](const Scene& s) { return std::make_shared<const SweepTree>(*whole_tree(s)); }),
          *scene, desc.weights);
    const auto tree = trees_.of(scene, [&](const Scene& s) {
      return s.streamed() ? std::make_shared<const DeviceTree>(pool_of(s, *device_))
                          : upload_tree(s);
    });
    return create_partitioned_search(device_, tree, scene, kind, desc.weights, workers);
  }

  // Its tree is this view's alone.
  std::unique_ptr<CutSearch> search_of_baseline(const std::shared_ptr<const Scene>& scene,
                                                const SearchDesc& desc, Workers& workers) {
    const DetailTree detail = make_detail_tree(*whole_tree(*scene), scene->partition, desc.lod,
                                               workers, std::pmr::get_default_resource());
    if (desc.kind == Search::exhaustive)
      return create_exhaustive_search(device_, *scene, detail.tree, desc.weights);
    return create_partitioned_search(device_,
                                     std::make_shared<const DeviceTree>(detail.search, detail.tree),
                                     scene, desc.kind, desc.weights, workers);
  }

  std::shared_ptr<const Device> device_;
  SharedByScene<DeviceTree> trees_;
  SharedByScene<SweepTree> sweep_trees_;
  SharedByScene<DeviceScene> gaussians_;
  SharedByScene<DeviceParents> parents_;
};

}  // namespace

std::unique_ptr<Backend> create_cuda_backend(const BackendModuleOptions& options) {
  return std::make_unique<CudaBackend>(options);
}

}  // namespace voyager::cuda
