#include "tools/view/detail_map.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/open_source.h"
#include "runtime/format/reader.h"
#include "runtime/math/sh.h"
#include "tools/view/sample.h"

namespace voyager::view {
namespace {

struct DetailStopped {};

bool has_node_in(const std::vector<uint32_t>& nodes, const NodeRange& range) {
  const auto first = std::lower_bound(nodes.begin(), nodes.end(), range.first);
  return first != nodes.end() && *first - range.first < range.count;
}

void append_node(GaussianCloud& cloud, const Chunk& chunk, size_t i, double footprint) {
  const GaussianWords& words = chunk.words[i];
  const bool leaf = chunk.is_leaf(i);
  const Vec3f colour = detail_colour(leaf ? 0 : chunk.record_of(i).extent);
  for (int k = 0; k < 3; ++k) cloud.position.push_back(words.mean[k]);
  for (int k = 0; k < 3; ++k) {
    const double scale = std::exp(double{words.log_scale[k]});
    cloud.log_scale.push_back(static_cast<float>(std::log(scale * scale + footprint) / 2));
  }
  for (const float q : {words.rotation.w, words.rotation.x, words.rotation.y, words.rotation.z})
    cloud.rotation.push_back(q);
  cloud.opacity.push_back(leaf ? words.opacity : flat_logit(words.opacity));
  for (int k = 0; k < 3; ++k) cloud.sh.push_back((colour[k] - 0.5f) / static_cast<float>(kSh0));
}

GaussianCloud coloured_cut(const SceneFile& file, const std::vector<uint32_t>& nodes,
                           double footprint, const std::atomic<bool>& stopped) {
  GaussianCloud cloud;
  cloud.origin = file.info().origin;
  for (uint32_t index = 0; index < file.chunks().size(); ++index) {
    if (stopped) throw DetailStopped();
    const std::vector<NodeRange> ranges = file.nodes_of(index);
    if (std::none_of(ranges.begin(), ranges.end(),
                     [&](const NodeRange& range) { return has_node_in(nodes, range); }))
      continue;
    const Chunk chunk = file.read_chunk(index);
    for (size_t i = 0; i < chunk.node.size(); ++i)
      if (std::binary_search(nodes.begin(), nodes.end(), chunk.node[i]))
        append_node(cloud, chunk, i, footprint);
  }
  return cloud;
}

}  // namespace

// Blue, green, yellow, red from fine to coarse.
Vec3f detail_colour(float extent) {
  if (extent <= 0) return {0.75f, 0.75f, 0.78f};
  constexpr Vec3f kScale[] = {
      {0.15f, 0.3f, 0.95f}, {0.1f, 0.75f, 0.6f}, {0.95f, 0.85f, 0.15f}, {0.9f, 0.1f, 0.1f}};
  const float along =
      std::clamp(std::log(extent / kFinestExtent) / std::log(kCoarsestExtent / kFinestExtent), 0.0f,
                 1.0f) *
      3;
  const int from = std::min(static_cast<int>(along), 2);
  const float t = along - static_cast<float>(from);
  return (1 - t) * kScale[from] + t * kScale[from + 1];
}

DetailJob::DetailJob(const voy::Device& device, std::string file, std::vector<uint32_t> nodes,
                     double footprint)
    : device_(device),
      file_(std::move(file)),
      nodes_(std::move(nodes)),
      footprint_(footprint),
      thread_([this] { run(); }) {}

DetailJob::~DetailJob() {
  stopped_ = true;
  thread_.join();
}

void DetailJob::run() {
  try {
    const SceneFile file(open_source(file_));
    LoadedScene scene;
    scene.memory =
        std::make_unique<MemoryFile>(file.name() + ", its level of detail",
                                     as_ply(coloured_cut(file, nodes_, footprint_, stopped_)));
    const VoyByteSource bytes = scene.memory->source();
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.source = &bytes;
    scene.scene = device_.open_scene(desc);
    scene.info = scene.scene.info();
    result_ = std::move(scene);
  } catch (const DetailStopped&) {
  } catch (const std::exception& problem) {
    error_ = refusal_of(problem);
  }
  done_ = true;
}

}  // namespace voyager::view
