// What libvoyager_cuda.so exports.
#include <algorithm>
#include <cstring>
#include <mutex>

#include "cuda/search.h"
#include "runtime/base/error.h"
#include "runtime/frame/backend_module.h"

namespace voyager::cuda {
namespace {

class CudaBackend final : public Backend {
 public:
  explicit CudaBackend(const BackendModuleOptions& options)
      : device_(std::make_shared<Device>(options.device, options.multiprocessors)) {}

  std::string device_name() const override {
    return device_->name() + ", " + std::to_string(device_->multiprocessors()) + " multiprocessors";
  }

  std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Scene>, const PipelineDesc&,
                                            std::pmr::memory_resource*, Workers&) override {
    throw Error(ErrorCode::unsupported,
                "the CUDA backend: found a view to draw, this version only searches with CUDA");
  }

  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc, std::pmr::memory_resource*,
                                             Workers&) override {
    if (!scene->damaged_chunks.empty())
      throw Error(ErrorCode::damaged_chunk, scene->damaged_chunks.front().message +
                                                " (CUDA searches whole scenes in this version)");
    if (desc.kind == Search::exhaustive)
      return create_exhaustive_search(device_, std::move(scene), desc.weights);
    device_->use();
    return create_partitioned_search(device_, tree_of(scene), scene, desc.kind, desc.weights);
  }

 private:
  // Views of one scene share its arrays for as long as one of them is there.
  std::shared_ptr<const DeviceTree> tree_of(const std::shared_ptr<const Scene>& scene) {
    const std::lock_guard lock(mutex_);
    if (scene_.lock() == scene)
      if (auto tree = tree_.lock()) return tree;
    const auto tree = upload_tree(*scene);
    scene_ = scene;
    tree_ = tree;
    return tree;
  }

  std::shared_ptr<const Device> device_;
  std::mutex mutex_;
  std::weak_ptr<const Scene> scene_;
  std::weak_ptr<const DeviceTree> tree_;
};

Backend* create(const BackendModuleOptions& options, ErrorCode* code, char* message, size_t size) {
  std::string what;
  try {
    return new CudaBackend(options);
  } catch (const Error& error) {
    *code = error.code();
    what = error.what();
  } catch (const std::exception& error) {
    *code = ErrorCode::internal;
    what = error.what();
  }
  const size_t length = std::min(size - 1, what.size());
  std::memcpy(message, what.data(), length);
  message[length] = '\0';
  return nullptr;
}

}  // namespace
}  // namespace voyager::cuda

extern "C" __attribute__((visibility("default")))
const voyager::BackendModule voyager_backend_module = {voyager::backend_module_stamp(),
                                                       voyager::cuda::create};
