#include "runtime/reference/reference_backend.h"

#include <cmath>
#include <deque>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/frame/depth_order.h"
#include "runtime/frame/host_instances.h"
#include "runtime/frame/host_pipeline.h"
#include "runtime/frame/resolve.h"
#include "runtime/reference/project.h"

namespace voyager {
namespace {

using reference::Splat;

constexpr size_t kBandRows = 8;
constexpr size_t kBlock = 4096;

struct Pixel {
  double r = 0, g = 0, b = 0, transmittance = 1;
  double depth = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::infinity();
  bool ended = false;
};

// METHOD §6 at one pixel.
void blend(const Splat& s, double x, double y, Pixel& pixel) {
  if (pixel.ended || s.depth > pixel.limit) return;
  const double dx = x + 0.5 - s.x, dy = y + 0.5 - s.y;
  const double p = dx * s.conic.p_x, q = (dy - s.conic.skew * dx) * s.conic.q_y;
  const double rho = -(p * p + q * q);
  if (!(rho >= s.rho_min)) return;
  double alpha = std::fmin(double{kAlphaMax}, s.opacity * std::exp(rho));
  if (s.t < 1) alpha = sibling_alpha(alpha, s.t, s.inverse_k);
  const double after = pixel.transmittance * (1 - alpha);
  if (after < double{kTransmittanceEnd}) {
    pixel.ended = true;
    return;
  }
  const double weight = alpha * pixel.transmittance;
  pixel.r += weight * s.colour.x;
  pixel.g += weight * s.colour.y;
  pixel.b += weight * s.colour.z;
  if (pixel.transmittance > 0.5 && after <= 0.5) pixel.depth = s.depth;
  pixel.transmittance = after;
}

class ReferencePipeline final : public HostPipeline {
 public:
  ReferencePipeline(const Scenes& scenes, const PipelineDesc& desc,
                    std::pmr::memory_resource* memory, Workers& workers)
      : desc_(desc),
        workers_(workers),
        instances_(scenes, desc, 1, memory, workers),
        keys_(memory) {
    for (uint32_t eye = 0; eye < desc.eyes; ++eye) eyes_.emplace_back(memory);
  }

  void set_scenes(const Scenes& scenes, std::span<const size_t> from) override {
    instances_.set_scenes(scenes, from);
  }
  void search(const FrameInput& frame) override { instances_.update(frame); }

  void project(const FrameInput&) override {
    for (size_t eye = 0; eye < eyes_.size(); ++eye) {
      eyes_[eye].splats.resize(instances_.places());
      eyes_[eye].visible.assign(instances_.places(), 0);
      for (const auto& instance : instances_.all()) project(*instance, eye);
    }
  }

  void sort(size_t eye) override {
    const Eye& of = eyes_[eye];
    keys_.clear();
    for (size_t i = 0; i < of.splats.size(); ++i)
      if (of.visible[i]) keys_.push_back(depth_key(of.splats[i].depth, static_cast<uint32_t>(i)));
    sort_by_depth(keys_, workers_);
  }

  void bin(const FrameInput&, size_t) override {}

  void rasterize(const FrameInput& frame, size_t eye) override {
    const FrameEye& wanted = frame.eyes[eye];
    const size_t width = wanted.camera.width, height = wanted.camera.height;
    const std::pmr::vector<Splat>& splats = eyes_[eye].splats;
    std::pmr::vector<Pixel>& pixels = eyes_[eye].pixels;
    pixels.assign(width * height, Pixel{});
    if (wanted.limits.values != nullptr)
      for (size_t i = 0; i < pixels.size(); ++i)
        pixels[i].limit = wanted.limits.at(i % width, i / width);
    workers_.for_blocks(height, kBandRows, [&](size_t begin, size_t end) {
      for (const uint64_t key : keys_) {
        const Splat& s = splats[depth_key_index(key)];
        const auto rows =
            desc_.alpha_filter ? covered(s.y, s.half_height, begin, end) : std::pair(begin, end);
        const auto columns =
            desc_.alpha_filter ? covered(s.x, s.half_width, 0, width) : std::pair(size_t{0}, width);
        for (size_t y = rows.first; y < rows.second; ++y)
          for (size_t x = columns.first; x < columns.second; ++x)
            blend(s, static_cast<double>(x), static_cast<double>(y), pixels[y * width + x]);
      }
    });
  }

  void write(const FrameInput& frame, size_t eye) override {
    const std::pmr::vector<Pixel>& pixels = eyes_[eye].pixels;
    resolve_image(
        frame.eyes[eye].image, frame.background, workers_,
        [&](size_t i) -> const Pixel& { return pixels[i]; },
        [&](size_t i) { return pixels[i].depth; });
  }

  void collect_eye(FrameStats& stats) const override { stats.splats += keys_.size(); }
  void collect(FrameStats& stats) const override { instances_.collect(stats); }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    instances_.read_cut(instance, cut);
  }
  bool cut_is_near() const override { return true; }

 private:
  struct Eye {
    explicit Eye(std::pmr::memory_resource* memory)
        : splats(memory), visible(memory), pixels(memory) {}
    std::pmr::vector<Splat> splats;
    std::pmr::vector<uint8_t> visible;
    std::pmr::vector<Pixel> pixels;
  };

  void project(const HostInstance& instance, size_t eye) {
    Eye& of = eyes_[eye];
    const auto& items = instance.draws.items();
    workers_.for_blocks(items.size(), kBlock, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        if (const auto splat = reference::project(*instance.scene, instance.cameras[eye], desc_,
                                                  instance.look, items[i])) {
          of.splats[instance.first + i] = *splat;
          of.visible[instance.first + i] = 1;
        }
    });
  }

  // The pixels of [low, high) whose centres the support's box reaches.
  static std::pair<size_t, size_t> covered(double centre, double reach, size_t low, size_t high) {
    const double first = std::ceil(centre - reach - 0.5), last = std::floor(centre + reach - 0.5);
    const double from = std::fmax(first, static_cast<double>(low));
    const double to = std::fmin(last + 1, static_cast<double>(high));
    return from < to ? std::pair(static_cast<size_t>(from), static_cast<size_t>(to))
                     : std::pair(low, low);
  }

  PipelineDesc desc_;
  Workers& workers_;
  HostInstances instances_;
  std::deque<Eye> eyes_;             // which are never moved
  std::pmr::vector<uint64_t> keys_;  // of the eye in turn
};

class ReferenceBackend final : public Backend {
 public:
  std::string device_name() const override { return "float64 reference"; }
  std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                            std::pmr::memory_resource* memory,
                                            Workers& workers) override {
    if (desc.exponential != Exponential::exact)
      throw Error(ErrorCode::unsupported, "exponential: the reference backend has exact only");
    if (desc.splatting != Splatting::ours)
      throw Error(ErrorCode::unsupported,
                  "splatting: found 3dgs, the reference backend has ours only (CUDA has both)");
    return std::make_unique<ReferencePipeline>(scenes, desc, memory, workers);
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc,
                                             std::pmr::memory_resource* memory,
                                             Workers& workers) override {
    return create_host_search(std::move(scene), desc, memory, workers);
  }
};

}  // namespace

std::unique_ptr<Backend> create_reference_backend() {
  return std::make_unique<ReferenceBackend>();
}

}  // namespace voyager
