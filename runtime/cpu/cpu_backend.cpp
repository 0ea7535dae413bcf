#include "runtime/cpu/cpu_backend.h"
#include "runtime/cpu/node_trainer.h"

#include <algorithm>
#include <atomic>
#include <deque>

#include "runtime/base/error.h"
#include "runtime/cpu/bin.h"
#include "runtime/cpu/rasterize.h"
#include "runtime/frame/choice_omission.h"
#include "runtime/frame/depth_order.h"
#include "runtime/frame/host_instances.h"
#include "runtime/frame/host_pipeline.h"
#include "runtime/frame/project_params.h"
#include "runtime/frame/resolve.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/math/alpha_lut.h"

namespace voyager {
namespace {

using namespace cpu;

constexpr size_t kProjectBlock = 4096;

class CpuPipeline final : public HostPipeline {
 public:
  CpuPipeline(const Scenes& scenes, const PipelineDesc& desc, std::pmr::memory_resource* memory,
              Workers& workers)
      : desc_(desc),
        workers_(workers),
        instances_(scenes, desc, kProjectBlock, memory, workers),
        keys_(memory),
        order_(memory),
        bins_(memory),
        lut_(memory) {
    for (uint32_t eye = 0; eye < desc.eyes; ++eye) eyes_.emplace_back(memory);
    if (desc.exponential != Exponential::lut) return;
    lut_.resize(desc.lut_size + 1);
    fill_alpha_lut(desc.lut_size, lut_.data());
  }

  void set_scenes(const Scenes& scenes, std::span<const size_t> from) override {
    instances_.set_scenes(scenes, from);
  }
  void search(const FrameInput& frame) override { instances_.update(frame); }
  void project(const FrameInput& frame) override;
  void sort(size_t eye) override;
  void bin(const FrameInput& frame, size_t eye) override;
  void rasterize(const FrameInput& frame, size_t eye) override;
  void write(const FrameInput& frame, size_t eye) override {
    const Eye& of = eyes_[eye];
    resolve_image(
        frame.eyes[eye].image, frame.background, workers_,
        [&](size_t i) -> const Pixel& { return of.pixels[i]; },
        [&](size_t i) { return of.depth[i]; });
  }

  void collect_eye(FrameStats& stats) const override {
    stats.splats += order_.size();
    stats.pairs_before += bins_.pairs_before();
    stats.pairs_after += bins_.pairs_after();
  }
  void collect(FrameStats& stats) const override { instances_.collect(stats); }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    instances_.read_cut(instance, cut);
  }
  const ShownChunks* shown_chunks(size_t instance) const override {
    const ShownChunks& shown = instances_.all()[instance]->shown;
    return shown.empty() ? nullptr : &shown;
  }
  bool cut_is_near() const override { return true; }
  std::vector<Omission> omissions() const override;

 private:
  struct Eye {
    explicit Eye(std::pmr::memory_resource* memory)
        : splats(memory), visible(memory), shown(memory), pixels(memory), depth(memory) {}
    std::pmr::vector<Splat> splats;      // of a block of places, from its first on
    std::pmr::vector<uint32_t> visible;  // splats of each block
    std::pmr::vector<Shown*> shown;      // by splat, what is told of it; none where nothing is
    std::pmr::vector<Pixel> pixels;
    std::pmr::vector<float> depth;
  };

  template <int kEyes>
  void project_instance(HostInstance& instance);

  PipelineDesc desc_;
  Workers& workers_;
  HostInstances instances_;
  std::deque<Eye> eyes_;  // which are never moved
  // Of the eye in turn.
  std::pmr::vector<uint64_t> keys_;
  std::pmr::vector<uint32_t> order_;  // splats by depth
  TileBins bins_;
  std::pmr::vector<float> lut_;
  bool limited_ = false;  // some frame was
};

void CpuPipeline::project(const FrameInput&) {
  const size_t places = instances_.places();
  bool tells = false;
  for (const auto& instance : instances_.all()) {
    const Scene& scene = *instance->scene;
    const bool wanted = scene.streamed() && scene.stream->wants_shown();
    instance->shown.assign(wanted ? scene.slot_ids.size() : 0, Shown::unknown);
    tells = tells || wanted;
  }
  for (Eye& eye : eyes_) {
    eye.shown.assign(tells ? places : 0, nullptr);
    if (eye.splats.size() < places) eye.splats.resize(places);
    eye.visible.assign((places + kProjectBlock - 1) / kProjectBlock, 0);
  }
  for (const auto& instance : instances_.all())
    eyes_.size() == 1 ? project_instance<1>(*instance) : project_instance<2>(*instance);
}

template <int kEyes>
void CpuPipeline::project_instance(HostInstance& instance) {
  const auto& items = instance.draws.items();
  ProjectParams params[kEyes];
  for (size_t eye = 0; eye < kEyes; ++eye)
    params[eye] = project_params(*instance.scene, instance.cameras[eye], desc_, instance.look);
  const GaussianArrays arrays = gaussian_arrays(*instance.scene);
  workers_.for_blocks(items.size(), kProjectBlock, [&](size_t begin, size_t end) {
    const size_t first = instance.first + begin;
    size_t out[kEyes];
    for (size_t& at : out) at = first;
    for (size_t i = begin; i < end; ++i) {
      const DrawItem item = drawn_item(items[i], arrays.doubles);
      const Vec3f mean = interpolated_mean(arrays, item);
      if (!is_inside(params[0].clip, mean)) continue;
      // Restoring codes is most of what one outside the image would cost.
      const bool bounds = arrays.coded() && item.t == 1.0f;
      const float scale = bounds ? arrays.largest_scale(item.gaussian) : 0.0f;
      const float radius =
          bounds ? support_bound(arrays.log_opacity(item.gaussian), params[0].log_threshold) : 0.0f;
      const auto sees = [&](const ProjectParams& eye) {
        return bounds ? may_reach(eye, mean, scale, radius) : before_near_plane(eye, mean);
      };
      DrawnGaussian drawn;
      if (std::none_of(params, params + kEyes, sees) ||
          !read_gaussian(params[0], arrays, item, drawn))
        continue;
      Shown* const shown = instance.shown.empty()
                               ? nullptr
                               : &instance.shown[item.gaussian / instance.scene->slot_nodes];
      for (size_t eye = 0; eye < kEyes; ++eye) {
        Eye& of = eyes_[eye];
        if (!voyager::project(params[eye], arrays, item, drawn, of.splats[out[eye]])) continue;
        if (shown != nullptr) {
          std::atomic_ref(*shown).store(Shown::no, std::memory_order_relaxed);
          of.shown[out[eye]] = shown;
        }
        ++out[eye];
      }
    }
    for (size_t eye = 0; eye < kEyes; ++eye)
      eyes_[eye].visible[first / kProjectBlock] = static_cast<uint32_t>(out[eye] - first);
  });
}

void CpuPipeline::sort(size_t eye) {
  const Eye& of = eyes_[eye];
  keys_.clear();
  for (size_t block = 0; block < of.visible.size(); ++block)
    for (size_t i = 0; i < of.visible[block]; ++i) {
      const auto index = static_cast<uint32_t>(block * kProjectBlock + i);
      keys_.push_back(depth_key(of.splats[index].depth, index));
    }
  sort_by_depth(keys_, workers_);
  order_.resize(keys_.size());
  for (size_t i = 0; i < keys_.size(); ++i) order_[i] = depth_key_index(keys_[i]);
}

void CpuPipeline::bin(const FrameInput& frame, size_t eye) {
  const Camera& camera = frame.eyes[eye].camera;
  bins_.build(eyes_[eye].splats.data(), order_, tile_grid(camera.width, camera.height),
              desc_.alpha_filter, workers_);
}

void CpuPipeline::rasterize(const FrameInput& frame, size_t eye) {
  Eye& of = eyes_[eye];
  const FrameEye& wanted = frame.eyes[eye];
  const uint32_t width = wanted.camera.width, height = wanted.camera.height;
  const size_t count = size_t{width} * height;
  if (of.pixels.size() < count) of.pixels.resize(count);
  const bool limits = wanted.limits.values != nullptr, depth = wanted.depth_wanted || limits;
  if (depth && of.depth.size() < count) of.depth.resize(count);
  limited_ = limited_ || limits;
  const RasterParams params{of.splats.data(),
                            lut_.data(),
                            static_cast<float>(desc_.lut_size) / kLutRange,
                            width,
                            height,
                            of.pixels.data(),
                            depth ? of.depth.data() : nullptr,
                            wanted.limits,
                            of.shown.empty() ? nullptr : of.shown.data()};
  const RasterizeTile run = pick_rasterizer(desc_.exponential, desc_.alpha_filter, depth, limits);
  const TileGrid grid = tile_grid(width, height);
  const auto columns = static_cast<uint32_t>(grid.columns);
  workers_.for_blocks(size_t{columns} * static_cast<size_t>(grid.rows), 1,
                      [&](size_t index, size_t) {
                        const auto tile = static_cast<uint32_t>(index);
                        run(params, {tile % columns, tile / columns, bins_.tile(index)});
                      });
}

std::vector<Omission> CpuPipeline::omissions() const {
  ViewShape shape;
  shape.eyes = desc_.eyes;
  for (const Eye& eye : eyes_) {
    shape.pixels = std::max<uint64_t>(shape.pixels, eye.pixels.size());
    shape.depth = shape.depth || !eye.depth.empty();
    shape.eye_bytes = std::max<uint64_t>(
        shape.eye_bytes, eye.splats.size() * sizeof(Splat) + eye.pixels.size() * sizeof(Pixel));
  }
  std::vector<Omission> all = omissions_of(shape);
  // Limits are read where the host has them.
  for (Omission& omission : omissions_of(ViewChoices{desc_, limited_, 0}, shape))
    all.push_back(std::move(omission));
  return all;
}

class CpuBackend final : public Backend {
 public:
  std::string device_name() const override {
    return std::string("CPU (") + rasterizers().back().name + ")";
  }
  std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                            std::pmr::memory_resource* memory,
                                            Workers& workers) override {
    if (desc.splatting != Splatting::ours)
      throw Error(ErrorCode::unsupported,
                  "splatting: found 3dgs, the CPU backend has ours only (CUDA has both)");
    if (desc.exponential == Exponential::half2)
      throw Error(ErrorCode::unsupported,
                  "exponential: found half2, the CPU backend has exact, ex2 and lut");
    require_exponential_for_truth(desc);
    return std::make_unique<CpuPipeline>(scenes, desc, memory, workers);
  }
  std::unique_ptr<NodeTrainer> create_trainer(const std::shared_ptr<const Scene>& scene,
                                              Workers& workers) override {
    return create_host_trainer(scene, *this, workers);
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc,
                                             std::pmr::memory_resource* memory,
                                             Workers& workers) override {
    return create_host_search(std::move(scene), desc, memory, workers);
  }
};

}  // namespace

std::unique_ptr<Backend> create_cpu_backend() {
  return std::make_unique<CpuBackend>();
}

}  // namespace voyager
