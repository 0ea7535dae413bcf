#include "runtime/cpu/node_trainer.h"

#include <algorithm>

#include "runtime/cpu/train_picture.h"
#include "runtime/frame/draw_list.h"
#include "runtime/frame/project_params.h"
#include "runtime/select/cut.h"

namespace voyager {
namespace {

constexpr size_t kGradientsBlock = 512;
constexpr size_t kKeptTruths = 32;

PipelineDesc truth_desc() {
  PipelineDesc desc;
  desc.lod = Lod::all_leaves;
  desc.exponential = Exponential::ex2;
  desc.antialias = Antialias::truth;
  return desc;
}

class HostTrainer final : public NodeTrainer {
 public:
  HostTrainer(std::shared_ptr<const Scene> scene, Backend& backend, Workers& workers)
      : scene_(std::move(scene)),
        workers_(workers),
        truth_(backend.create_pipeline({scene_}, truth_desc(), std::pmr::get_default_resource(),
                                       workers)),
        numbers_(static_cast<size_t>(numbers_of(scene_->sh_degree))),
        tree_(scene_->tree),
        gaussians_(scene_->gaussians.begin(), scene_->gaussians.end()),
        sh_(scene_->sh.begin(), scene_->sh.end()),
        row_of_(tree_.size(), kNoNode) {
    for (uint32_t n = 0; n < tree_.size(); ++n) {
      if (tree_.is_leaf(n)) {
        leaves_.push_back({n, kNoNode, 1.0f, 1.0f});
      } else {
        row_of_[n] = static_cast<uint32_t>(nodes_.size());
        nodes_.push_back(n);
      }
    }
    learned_.first.resize(nodes_.size() * numbers_);
    learned_.second.resize(nodes_.size() * numbers_);
    learned_.steps.resize(nodes_.size());
  }

  TrainingError step(const TrainingView& view, const LearningRates& rates) override;
  TrainingError error(const TrainingView& view) override {
    find_cut(view);
    return compare(view, cut_);
  }
  TrainingError error_of_leaves(const TrainingView& view) override {
    return compare(view, leaves_);
  }
  std::vector<NodeError> node_errors(const TrainingView& view) override;
  void set_extents(const std::vector<float>& extents) override {
    for (size_t n = 0; n < extents.size(); ++n) tree_.records[n].extent = extents[n];
  }
  TrainingState state() const override;
  void set_state(const TrainingState& state) override;

 private:
  // Of an item: as it was drawn, before it is shared between a node and its parent.
  struct Drawn {
    bool any = false;
    float sign = 1, opacity = 1;
    float shape[kShapeNumbers] = {};
    float sh[3 * sh_coefficients(kMaxShDegree)] = {};
  };

  size_t coefficients() const { return 3 * static_cast<size_t>(scene_->coefficients()); }
  GaussianArrays arrays() const {
    return {gaussians_.data(), sh_.data(), scene_->node_code.data(),
            scene_->sh_degree, false,      footprints_differ(*scene_)};
  }
  ProjectParams params(const TrainingView& view) const {
    PipelineDesc desc;
    desc.antialias = Antialias::on;
    return project_params(*scene_, view.camera, desc);
  }
  std::vector<TrainPixel> draw_truth(const TrainingView& view);
  // The same views are compared again and again: the truth of the last few is kept.
  const std::vector<TrainPixel>& kept_truth(const TrainingView& view);
  void find_cut(const TrainingView& view);
  TrainingError compare(const TrainingView& view, std::span<const DrawItem> items);
  Drawn gradient_of(const ProjectParams& params, const DrawItem& item, const TrainSums& sums,
                    const Vec3f& colour) const;
  // The node moves by what these items say of it.
  void move(uint32_t node, std::span<const DrawItem> items, std::span<const Drawn> drawn,
            bool parent, const LearningRates& rates);

  std::shared_ptr<const Scene> scene_;
  Workers& workers_;
  std::unique_ptr<Pipeline> truth_;
  size_t numbers_;
  LodTree tree_;
  std::vector<Gaussian> gaussians_;
  std::vector<float> sh_;
  std::vector<uint32_t> row_of_, nodes_;
  std::vector<DrawItem> leaves_, cut_;
  ExhaustiveSearch search_;
  struct KeptTruth {
    TruthOf of;
    std::vector<TrainPixel> pixels;
  };
  std::vector<KeptTruth> truths_;
  size_t next_truth_ = 0;
  TrainingState learned_;  // moments and steps
};

std::vector<TrainPixel> HostTrainer::draw_truth(const TrainingView& view) {
  const uint32_t samples = view.samples;
  FrameInput frame;
  const Camera camera = truth_camera(view);
  frame.eyes[0].camera = camera;
  std::vector<TrainPixel> fine(size_t{camera.width} * camera.height);
  Image& image = frame.eyes[0].image;
  image.format = ColorFormat::rgba32f;
  image.width = camera.width, image.height = camera.height;
  image.color = fine.data();
  image.color_pitch = camera.width * sizeof(TrainPixel);
  FrameStats stats;
  truth_->draw(frame, stats);
  truth_->resolve(frame, stats);

  const uint32_t width = view.camera.width;
  std::vector<TrainPixel> mean(size_t{width} * view.camera.height);
  const float share = 1.0f / static_cast<float>(samples * samples);
  workers_.for_blocks(view.camera.height, 8, [&](size_t begin, size_t end) {
    for (size_t row = begin * samples; row < end * samples; ++row)
      for (size_t column = 0; column < camera.width; ++column) {
        const TrainPixel& sample = fine[row * camera.width + column];
        TrainPixel& of = mean[row / samples * width + column / samples];
        of.r += share * sample.r, of.g += share * sample.g, of.b += share * sample.b;
        of.alpha += share * sample.alpha;
      }
  });
  return mean;
}

const std::vector<TrainPixel>& HostTrainer::kept_truth(const TrainingView& view) {
  for (const KeptTruth& truth : truths_)
    if (truth.of == truth_of(view)) return truth.pixels;
  KeptTruth truth{truth_of(view), draw_truth(view)};
  if (truths_.size() < kKeptTruths) {
    truths_.push_back(std::move(truth));
    return truths_.back().pixels;
  }
  const size_t at = next_truth_++ % kKeptTruths;
  truths_[at] = std::move(truth);
  return truths_[at].pixels;
}

void HostTrainer::find_cut(const TrainingView& view) {
  const Camera& camera = view.camera;
  const CutQuery query{cut_centre(camera.eye, scene_->origin), target_size(view.tau, camera.fx)};
  search_.run(tree_, {}, query, workers_);
  const WeightParams weights{tree_.records.data(), tree_.parent.data(), search_.sizes().data(),
                             query.target_size, tree_.blend_share};
  cut_.resize(search_.cut().size());
  workers_.for_blocks(cut_.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) cut_[i] = weigh(weights, search_.cut()[i]);
  });
}

TrainingError HostTrainer::compare(const TrainingView& view, std::span<const DrawItem> items) {
  const TrainPicture picture(params(view), arrays(), items, workers_);
  return {picture.squares(kept_truth(view)), static_cast<uint32_t>(items.size())};
}

SplatSums<float> in_binary32(const SplatSums<double>& s) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return {f(s.g),
          f(s.gp),
          f(s.gq),
          f(s.gpp),
          f(s.gpq),
          f(s.gqq),
          {f(s.colour.x), f(s.colour.y), f(s.colour.z)}};
}

HostTrainer::Drawn HostTrainer::gradient_of(const ProjectParams& params, const DrawItem& item,
                                            const TrainSums& sums, const Vec3f& colour) const {
  Drawn drawn;
  if (!sums.any) return drawn;
  const GaussianArrays of = arrays();
  const Vec3f relative = camera_relative(interpolated_mean(of, item), params.origin, params.eye);
  const Shape<float> shape = interpolated_shape<float>(of, item);
  const SplatSums<float> single = in_binary32(sums.sums);
  GaussianGradient<float> g = shape_gradient(params.view, filter_of(params, of, item),
                                             params.log_scale, relative, shape, single);
  const auto own = of.sh(item.gaussian),
             parent = of.sh(item.t == 1.0f ? item.gaussian : item.parent);
  const auto blended = [&](int k, int channel) {
    return lerp(parent(k, channel), own(k, channel), item.t);
  };
  const auto put = [&](int k, int channel, float by) {
    drawn.sh[static_cast<size_t>(3 * k + channel)] = by;
  };
  g.mean = g.mean + colour_gradient(of.degree, relative, colour, single.colour, blended, put);
  const float numbers[] = {g.mean.x,     g.mean.y,     g.mean.z,     g.scale.x,
                           g.scale.y,    g.scale.z,    g.rotation.w, g.rotation.x,
                           g.rotation.y, g.rotation.z, g.log_opacity};
  std::copy(std::begin(numbers), std::end(numbers), drawn.shape);
  drawn.any =
      std::all_of(std::begin(numbers), std::end(numbers), [](float x) { return std::isfinite(x); });
  drawn.sign = parent_sign(of, item);
  drawn.opacity = shape.opacity;
  return drawn;
}

void HostTrainer::move(uint32_t node, std::span<const DrawItem> items, std::span<const Drawn> drawn,
                       bool parent, const LearningRates& rates) {
  const uint32_t row = row_of_[node];
  if (row == kNoNode) return;
  Gaussian& g = gaussians_[node];
  ShapeGradient gradient;
  std::vector<float> by_sh(coefficients());
  bool any = false;
  for (size_t i = 0; i < items.size(); ++i) {
    if (!drawn[i].any) continue;
    any = true;
    const float share = parent ? 1.0f - items[i].t : items[i].t;
    add_share(drawn[i].shape, share, parent ? drawn[i].sign : 1.0f, drawn[i].opacity, g, gradient);
    for (size_t k = 0; k < by_sh.size(); ++k) by_sh[k] += share * drawn[i].sh[k];
  }
  if (!any) return;
  const AdamStep step(rates, ++learned_.steps[row]);
  float* first = &learned_.first[row * numbers_];
  float* second = &learned_.second[row * numbers_];
  const float largest = detail::largest(g.scale);
  float moves[kShapeNumbers];
  for (int i = 0; i < kShapeNumbers; ++i)
    moves[i] = step.move(gradient.by[i], rates.of_shape(i, largest), first[i], second[i]);
  move_shape(moves, g);
  for (size_t k = 0; k < by_sh.size(); ++k)
    sh_[node * coefficients() + k] -=
        step.move(by_sh[k], rates.of_coefficient(static_cast<int>(k)), first[kShapeNumbers + k],
                  second[kShapeNumbers + k]);
}

TrainingError HostTrainer::step(const TrainingView& view, const LearningRates& rates) {
  find_cut(view);
  const ProjectParams projection = params(view);
  const TrainPicture picture(projection, arrays(), cut_, workers_);
  const std::vector<TrainPixel>& truth = kept_truth(view);
  const double squares = picture.squares(truth);
  const std::vector<TrainSums> sums = picture.adjoint(truth, loss_weight(view, squares), workers_);
  std::vector<Drawn> drawn(cut_.size());
  workers_.for_blocks(cut_.size(), kGradientsBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      if (sums[i].any)
        drawn[i] =
            gradient_of(projection, cut_[i], sums[i], picture.colour(static_cast<uint32_t>(i)));
  });
  const std::span<const DrawItem> items(cut_);
  const std::span<const Drawn> of(drawn);
  workers_.for_blocks(cut_.size(), kGradientsBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      move(cut_[i].gaussian, items.subspan(i, 1), of.subspan(i, 1), false, rates);
  });
  // Siblings are neighbours.
  workers_.for_blocks(cut_.size(), kGradientsBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t parent = cut_[i].parent;
      if (parent == kNoNode || (i != 0 && cut_[i - 1].parent == parent)) continue;
      size_t last = i + 1;
      while (last < cut_.size() && cut_[last].parent == parent) ++last;
      move(parent, items.subspan(i, last - i), of.subspan(i, last - i), true, rates);
    }
  });
  return {squares, static_cast<uint32_t>(cut_.size())};
}

std::vector<NodeError> HostTrainer::node_errors(const TrainingView& view) {
  find_cut(view);
  const TrainPicture picture(params(view), arrays(), cut_, workers_);
  const std::vector<TrainSums> sums = picture.adjoint(kept_truth(view), 1, workers_);
  std::vector<NodeError> errors;
  for (size_t i = 0; i < cut_.size(); ++i)
    if (sums[i].any && row_of_[cut_[i].gaussian] != kNoNode)
      errors.push_back({cut_[i].gaussian, static_cast<float>(sums[i].squares)});
  return errors;
}

TrainingState HostTrainer::state() const {
  TrainingState state = learned_;
  state.values.resize(nodes_.size() * numbers_);
  for (size_t row = 0; row < nodes_.size(); ++row) {
    const Gaussian& g = gaussians_[nodes_[row]];
    float* into = &state.values[row * numbers_];
    const float shape[] = {g.mean.x,     g.mean.y,     g.mean.z,     g.scale.x,
                           g.scale.y,    g.scale.z,    g.rotation.w, g.rotation.x,
                           g.rotation.y, g.rotation.z, g.log_opacity};
    std::copy(std::begin(shape), std::end(shape), into);
    std::copy_n(&sh_[nodes_[row] * coefficients()], coefficients(), into + kShapeNumbers);
    state.opacities.push_back(g.opacity);
  }
  return state;
}

void HostTrainer::set_state(const TrainingState& state) {
  learned_ = state;
  learned_.values = {}, learned_.opacities = {};
  for (size_t row = 0; row < nodes_.size(); ++row) {
    const float* v = &state.values[row * numbers_];
    gaussians_[nodes_[row]] = {{v[0], v[1], v[2]},
                               state.opacities[row],
                               {v[3], v[4], v[5]},
                               v[10],
                               {v[6], v[7], v[8], v[9]}};
    std::copy_n(v + kShapeNumbers, coefficients(), &sh_[nodes_[row] * coefficients()]);
  }
}

}  // namespace

std::unique_ptr<NodeTrainer> create_host_trainer(std::shared_ptr<const Scene> scene,
                                                 Backend& backend, Workers& workers) {
  return std::make_unique<HostTrainer>(std::move(scene), backend, workers);
}

}  // namespace voyager
