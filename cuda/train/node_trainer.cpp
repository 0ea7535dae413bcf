#include "cuda/train/node_trainer.h"

#include <algorithm>

#include "cuda/device/stream.h"
#include "cuda/device/upload_made.h"
#include "cuda/frame/draws.h"
#include "cuda/scene/device_gaussian.h"
#include "cuda/scene/device_parents.h"
#include "cuda/splat/splat_state.h"
#include "cuda/train/train_launch.h"
#include "runtime/frame/project_params.h"

namespace voyager::cuda {
namespace {

PipelineDesc desc_of(Antialias antialias) {
  PipelineDesc desc;
  desc.exponential = Exponential::ex2;
  desc.antialias = antialias;
  return desc;
}

// Merged nodes, ascending.
std::vector<uint32_t> merged_nodes(const LodTree& tree) {
  std::vector<uint32_t> nodes;
  for (uint32_t n = 0; n < tree.size(); ++n)
    if (!tree.is_leaf(n)) nodes.push_back(n);
  return nodes;
}

std::vector<uint32_t> rows_of(const LodTree& tree) {
  std::vector<uint32_t> rows(tree.size(), kNoNode);
  uint32_t row = 0;
  for (uint32_t n = 0; n < tree.size(); ++n)
    if (!tree.is_leaf(n)) rows[n] = row++;
  return rows;
}

template <class T>
void grow(Buffer<T>& buffer, size_t count) {
  if (buffer.size() >= count) return;
  buffer = {};
  buffer = Buffer<T>(count + count / 4);
}

// What one picture is drawn with.
struct Lists {
  Lists(unsigned blocks) : splats(blocks, 1), counters(sizeof(PassCounters)) {}

  SplatState splats;
  PinnedMemory counters;
  FrameTiles tiles{};
  Buffer<float4> picture;

  const PassCounters& counted() const {
    return *reinterpret_cast<const PassCounters*>(counters.data());
  }
  // Of the picture, whose work is done.
  std::vector<RankRow> ranks() const {
    const size_t places = std::min<size_t>(counted()[0].places, splats.room().places);
    return download(splats.view(tiles, 0).ranks, (places + kRowPlaces - 1) / kRowPlaces);
  }
};

class CudaTrainer final : public NodeTrainer {
 public:
  CudaTrainer(std::shared_ptr<const Device> device, std::shared_ptr<const Scene> scene)
      : device_(std::move(device)),
        scene_(std::move(scene)),
        nodes_(merged_nodes(scene_->tree)),
        numbers_(static_cast<size_t>(numbers_of(scene_->sh_degree))),
        hulls_(upload_made<float4>(size(),
                                   [&](size_t i) { return device_hull(scene_->gaussians[i]); })),
        shapes_(upload_made<float4>(
            2 * size(), [&](size_t i) { return device_shape(scene_->gaussians[i / 2], i % 2); })),
        opacities_(
            upload_made<float>(size(), [&](size_t i) { return scene_->gaussians[i].opacity; })),
        coefficients_(upload(std::span<const float>(scene_->sh))),
        node_codes_(upload(std::span<const uint8_t>(scene_->node_code))),
        row_of_(upload(std::span<const uint32_t>(rows_of(scene_->tree)))),
        first_(nodes_.size() * numbers_),
        second_(nodes_.size() * numbers_),
        steps_(nodes_.size()),
        squares_(1),
        found_(sizeof(FixedSum)),
        parents_(*scene_),
        leaves_(create_draws(*scene_, Lod::all_leaves, nullptr)),
        cut_(bin_blocks(device_->multiprocessors())),
        truth_(bin_blocks(device_->multiprocessors())) {
    fill(first_, 0), fill(second_, 0), fill(steps_, 0);
    view_.hulls = hulls_.data();
    view_.shapes = shapes_.data();
    view_.coefficients = coefficients_.data();
    view_.sh_degree = scene_->sh_degree;
    view_.sh_form = ShForm::single;
    view_.doubles = false;
    view_.footprints = footprints_differ(*scene_);
    view_.node_codes = node_codes_.data();
    view_.count = static_cast<uint32_t>(size());
    parents_.add_to(view_);
    view_.opacities = opacities_.data();
    search_ = create_exhaustive_search(device_, *scene_, scene_->tree, true);
  }

  // What it frees belongs to the device's context, and to work in flight.
  ~CudaTrainer() override {
    device_->use_quietly();
    cudaStreamSynchronize(stream_.get());
  }

  TrainingError step(const TrainingView& view, const LearningRates& rates) override {
    device_->use();
    const TrainingError error = compare(view, false);
    const uint32_t places = cut_.counted()[0].places;
    launch_sums(view, loss_weight(view, error.squares));
    grow(gradients_, size_t{places} * static_cast<size_t>(gradient_stride(scene_->sh_degree)));
    const SplatFrame frame = cut_frame(view);
    launch_train_project(frame, sums_.data(), gradients_.data());
    launch_train_update(
        frame, gradients_.data(),
        {hulls_.data(), shapes_.data(), opacities_.data(), coefficients_.data(), row_of_.data(),
         first_.data(), second_.data(), steps_.data(), scene_->sh_degree},
        rates);
    return error;
  }

  TrainingError error(const TrainingView& view) override {
    device_->use();
    return compare(view, false);
  }
  TrainingError error_of_leaves(const TrainingView& view) override {
    device_->use();
    return compare(view, true);
  }

  std::vector<NodeError> node_errors(const TrainingView& view) override {
    device_->use();
    compare(view, false);
    launch_sums(view, 1);
    stream_.wait();
    std::vector<uint32_t> cut;
    std::vector<float> weights;
    search_->read(cut, weights);
    const std::vector<FixedSum> sums = download(sums_.data(), sums_in_use());
    const std::vector<RankRow> ranks = cut_.ranks();
    std::vector<NodeError> errors;
    for (uint32_t i = 0; i < std::min(cut.size(), ranks.size() * kRowPlaces); ++i) {
      const RankRow row = ranks[i / kRowPlaces];
      if (!row.has(i) || scene_->tree.is_leaf(cut[i])) continue;
      const FixedSum squares = sums[size_t{row.slot(i)} * kSums + 9];
      if (squares != 0) errors.push_back({cut[i], static_cast<float>(squares) / kFixedOne});
    }
    return errors;
  }

  void set_extents(const std::vector<float>& extents) override {
    device_->use();
    stream_.wait();
    LodTree tree = scene_->tree;
    for (size_t n = 0; n < extents.size(); ++n) tree.records[n].extent = extents[n];
    search_ = create_exhaustive_search(device_, *scene_, tree, true);
  }

  TrainingState state() const override;
  void set_state(const TrainingState& state) override;

 private:
  size_t size() const { return scene_->gaussians.size(); }
  size_t coefficients() const { return 3 * static_cast<size_t>(scene_->coefficients()); }

  SplatFrame frame_of(Lists& lists, const DrawView& draws, const Camera& camera,
                      Antialias antialias) {
    SplatFrame frame{};
    frame.gaussians = view_;
    frame.draws = draws;
    frame.params[0] = project_params(*scene_, camera, desc_of(antialias));
    frame.splats = lists.splats.view(lists.tiles, 0);
    frame.multiprocessors = device_->multiprocessors();
    frame.stream = stream_.get();
    return frame;
  }
  SplatFrame cut_frame(const TrainingView& view) {
    return frame_of(cut_, {search_->list(), nullptr}, view.camera, Antialias::on);
  }

  void launch_picture(Lists& lists, const DrawView& draws, const Camera& camera,
                      Antialias antialias);
  bool has_room(Lists& lists);
  void launch_truth(const TrainingView& view);
  TrainingError compare(const TrainingView& view, bool leaves);
  size_t sums_in_use() const { return size_t{cut_.counted()[0].slots} * kSums; }
  void launch_sums(const TrainingView& view, double weight);

  TrainPictures pictures(const Camera& camera, double weight = 1) const {
    return {cut_.picture.data(), truth_mean_.data(), camera.width, camera.height,
            static_cast<float>(weight)};
  }

  std::shared_ptr<const Device> device_;
  std::shared_ptr<const Scene> scene_;
  std::vector<uint32_t> nodes_;
  size_t numbers_;
  Buffer<float4> hulls_, shapes_;
  Buffer<float> opacities_, coefficients_;
  Buffer<uint8_t> node_codes_;
  Buffer<uint32_t> row_of_;
  Buffer<float> first_, second_;
  Buffer<uint32_t> steps_;
  Buffer<FixedSum> squares_;
  PinnedMemory found_;
  DeviceParents parents_;
  GaussianView view_{};
  std::unique_ptr<Draws> leaves_;
  std::unique_ptr<CutSearch> search_;
  Lists cut_, truth_;
  Buffer<float4> truth_mean_;
  TruthOf truth_drawn_;
  Buffer<FixedSum> sums_;
  Buffer<float> gradients_;
  Stream stream_;
};

void CudaTrainer::launch_picture(Lists& lists, const DrawView& draws, const Camera& camera,
                                 Antialias antialias) {
  FrameInput input;
  input.eyes[0].camera = camera;
  lists.tiles = frame_tiles(input);
  lists.splats.fit(lists.tiles);
  grow(lists.picture, size_t{camera.width} * camera.height);
  const cudaStream_t stream = stream_.get();
  lists.splats.begin_frame(lists.tiles, stream);
  const SplatFrame frame = frame_of(lists, draws, camera, antialias);
  launch_project(frame, true);
  launch_bin(frame);
  launch_sort(frame);
  RasterEye eye{};
  eye.target.format = ColorFormat::rgba32f;
  eye.target.color = lists.picture.data();
  eye.target.width = camera.width;
  eye.target.height = camera.height;
  launch_rasterize(
      frame, {Exponential::ex2, true, false, draws.blends(), nullptr, 0, log_threshold(antialias)},
      &eye);
  check(cudaMemcpyAsync(lists.counters.data(), lists.splats.counters(), sizeof(PassCounters),
                        cudaMemcpyDeviceToHost, stream),
        "counters");
}

void CudaTrainer::launch_truth(const TrainingView& view) {
  const Camera& camera = view.camera;
  launch_picture(truth_, leaves_->view(), truth_camera(view), Antialias::truth);
  grow(truth_mean_, size_t{camera.width} * camera.height);
  launch_mean(truth_.picture.data(), view.samples, truth_mean_.data(), camera.width, camera.height,
              stream_.get());
  truth_drawn_ = truth_of(view);
}

// False where lists are longer now: the picture is to be drawn again. What a picture has left out
// must not be learned from.
bool CudaTrainer::has_room(Lists& lists) {
  if (lists.splats.grow(room_for(lists.counted()))) return false;
  const uint64_t left_out = dropped(lists.counted(), lists.splats.room());
  if (left_out == 0) return true;
  throw Error(ErrorCode::over_budget, "device memory: found none for " + std::to_string(left_out) +
                                          " entries of a picture's lists, expected room for all");
}

// Lists that found too little room are made again with more.
TrainingError CudaTrainer::compare(const TrainingView& view, bool leaves) {
  const Camera& camera = view.camera;
  const cudaStream_t stream = stream_.get();
  if (!leaves) {
    const CutQuery query{cut_centre(camera.eye, scene_->origin), target_size(view.tau, camera.fx)};
    search_->find(query, stream);
    search_->weigh(query, stream);
  }
  const DrawView drawn = leaves ? leaves_->view() : DrawView{search_->list(), nullptr};
  for (;;) {
    if (truth_drawn_ != truth_of(view)) launch_truth(view);
    launch_picture(cut_, drawn, camera, Antialias::on);
    check(cudaMemsetAsync(squares_.data(), 0, squares_.bytes(), stream), "squares");
    launch_squares(pictures(camera), squares_.data(), stream);
    check(cudaMemcpyAsync(found_.data(), squares_.data(), sizeof(FixedSum), cudaMemcpyDeviceToHost,
                          stream),
          "squares");
    stream_.wait();
    const bool truth_fits = has_room(truth_), cut_fits = has_room(cut_);
    if (!truth_fits) truth_drawn_ = {};
    if (truth_fits && cut_fits) break;
  }
  const FixedSum squares = *reinterpret_cast<const FixedSum*>(found_.data());
  return {static_cast<double>(squares) / double{kFixedOne}, cut_.counted()[0].places};
}

void CudaTrainer::launch_sums(const TrainingView& view, double weight) {
  grow(sums_, sums_in_use());
  check(cudaMemsetAsync(sums_.data(), 0, sums_in_use() * sizeof(FixedSum), stream_.get()), "sums");
  launch_train_blend(cut_frame(view), pictures(view.camera, weight), log_threshold(Antialias::on),
                     sums_.data());
}

TrainingState CudaTrainer::state() const {
  device_->use();
  stream_.wait();
  TrainingState state;
  state.first = download(first_);
  state.second = download(second_);
  state.steps = download(steps_);
  state.values.resize(nodes_.size() * numbers_);
  const std::vector<float4> hulls = download(hulls_);
  const std::vector<float4> shapes = download(shapes_);
  const std::vector<float> sh = download(coefficients_);
  const std::vector<float> opacities = download(opacities_);
  for (size_t row = 0; row < nodes_.size(); ++row) {
    const size_t node = nodes_[row];
    const float4 hull = hulls[node], scale = shapes[2 * node], rotation = shapes[2 * node + 1];
    float* into = &state.values[row * numbers_];
    const float shape[kShapeNumbers] = {hull.x,     hull.y,     hull.z,     scale.x,
                                        scale.y,    scale.z,    rotation.x, rotation.y,
                                        rotation.z, rotation.w, scale.w};
    std::copy(std::begin(shape), std::end(shape), into);
    std::copy_n(&sh[node * coefficients()], coefficients(), into + kShapeNumbers);
    state.opacities.push_back(opacities[node]);
  }
  return state;
}

void CudaTrainer::set_state(const TrainingState& state) {
  device_->use();
  stream_.wait();
  std::vector<float4> hulls = download(hulls_);
  std::vector<float4> shapes = download(shapes_);
  std::vector<float> sh = download(coefficients_);
  std::vector<float> opacities = download(opacities_);
  for (size_t row = 0; row < nodes_.size(); ++row) {
    const size_t node = nodes_[row];
    const float* v = &state.values[row * numbers_];
    Gaussian g;
    g.mean = {v[0], v[1], v[2]};
    g.scale = {v[3], v[4], v[5]};
    g.rotation = {v[6], v[7], v[8], v[9]};
    g.log_opacity = v[10];
    g.opacity = state.opacities[row];
    hulls[node] = device_hull(g);
    for (size_t word = 0; word < 2; ++word) shapes[2 * node + word] = device_shape(g, word);
    opacities[node] = g.opacity;
    std::copy_n(v + kShapeNumbers, coefficients(), &sh[node * coefficients()]);
  }
  const auto put = [](const auto& from, const auto& into) {
    if (!from.empty())
      check(cudaMemcpy(into.data(), from.data(), into.bytes(), cudaMemcpyHostToDevice),
            "what was learned");
  };
  put(hulls, hulls_), put(shapes, shapes_), put(sh, coefficients_), put(opacities, opacities_);
  put(state.first, first_), put(state.second, second_), put(state.steps, steps_);
  check(cudaStreamSynchronize(nullptr), "what was learned");
}

}  // namespace

std::unique_ptr<NodeTrainer> create_node_trainer(std::shared_ptr<const Device> device,
                                                 std::shared_ptr<const Scene> scene) {
  device->use();
  return std::make_unique<CudaTrainer>(std::move(device), std::move(scene));
}

}  // namespace voyager::cuda
