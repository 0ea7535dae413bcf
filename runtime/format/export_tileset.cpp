#include "runtime/format/export_tileset.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/format/append_flat.h"
#include "runtime/format/tile_plan.h"
#include "runtime/format/tileset_json.h"
#include "runtime/format/tree_check.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

std::string name_of_tile(size_t tile) {
  char name[32];
  std::snprintf(name, sizeof name, "tile_%05zu.glb", tile);
  return name;
}

// How far a splat is seen from its mean, in the axes' own standard deviations: where its alpha is
// 1/255. 0 where it is nowhere.
double reach_of(float opacity) {
  const double levels = 255.0 * static_cast<double>(opacity);
  return levels <= 1 ? 0 : std::sqrt(2 * std::log(levels));
}

// What compression by SPZ may add to a splat's reach: half a step of its scale's logarithm, the
// smallest scale and half a step of its position, in metres from the tile's origin on.
struct Slack {
  double factor = 1, metres = 0;
};
Slack slack_of_spz(float largest_coordinate) {
  return {std::exp(1.0 / 32),
          3.4 * std::exp(-10.0) + std::ldexp(1.0, -spz_fractional_bits_inside(largest_coordinate))};
}

// Positions from the middle of the tile on, so that the steps of SPZ follow the size of the tile
// and not how far it is from the scene's origin. Whole metres, so that hardly a bit is lost.
void centre(GaussianCloud& cloud) {
  for (size_t axis = 0; axis < 3; ++axis) {
    float least = INFINITY, most = -INFINITY;
    for (size_t i = axis; i < cloud.position.size(); i += 3) {
      least = std::min(least, cloud.position[i]);
      most = std::max(most, cloud.position[i]);
    }
    const double middle = std::round((double{least} + double{most}) / 2);
    if (!std::isfinite(middle)) continue;
    cloud.origin[axis] += middle;
    for (size_t i = axis; i < cloud.position.size(); i += 3)
      cloud.position[i] = static_cast<float>(double{cloud.position[i]} - middle);
  }
}

TileBox box_of(const GaussianCloud& cloud, const Slack& slack) {
  TileBox box;
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Gaussian g = activate(cloud.words(i), true);
    const Mat3d turn = rotation(Quatd{g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z});
    const double reach = reach_of(g.opacity);
    TileBox splat;
    for (int axis = 0; axis < 3; ++axis) {
      double variance = 0;
      for (int k = 0; k < 3; ++k) {
        const double side = turn.row[axis][k] * double{g.scale[k]};
        variance += side * side;
      }
      const double mean = cloud.origin[static_cast<size_t>(axis)] + double{g.mean[axis]},
                   half = slack.factor * reach * std::sqrt(variance) + slack.metres;
      splat.least[axis] = mean - half;
      splat.most[axis] = mean + half;
    }
    box.add(splat);
  }
  return box;
}

// Bytes of one Gaussian, at most: compressed is never more than its codes, but for a little.
uint64_t bytes_of_one(int sh_degree, bool spz_inside) {
  const auto coefficients = static_cast<uint64_t>(sh_coefficients(sh_degree));
  return spz_inside ? 17 + 3 * coefficients : 4 * (11 + 3 * coefficients);
}

class TilesetExport {
 public:
  TilesetExport(const SceneFile& scene, const PlaceFile& place, const TilesetOptions& options,
                const Progress& progress)
      : scene_(scene), place_(place), options_(options), progress_(progress) {}

  TilesetSummary run() {
    read_tree();
    const int degree = scene_.info().sh_degree + scene_.info().left_out_bands;
    const uint64_t one = bytes_of_one(degree, options_.flat.spz_inside);
    plan_ = plan_tiles(tree_, std::max<uint64_t>(1, options_.tile_bytes / one));
    if (plan_.empty())
      throw Error(ErrorCode::unsupported,
                  scene_.name() + ": found no Gaussians, expected one at least");
    summary_.tiles = plan_.size();
    summary_.leaves = scene_.info().leaf_count;
    summary_.contents.sh_degree = degree;
    summary_.contents.native = scene_.info().native;
    entries_.resize(plan_.size());
    for (size_t i = 0; i < plan_.size(); ++i) {
      report(progress_, "exporting", i, plan_.size());
      write_tile(i);
    }
    join_volumes();
    write_json();
    report(progress_, "exporting", plan_.size(), plan_.size());
    return summary_;
  }

 private:
  void read_tree() {
    const uint32_t nodes = scene_.info().node_count;
    tree_ = TileTree(nodes);
    chunk_of_.resize(nodes);
    TreeCheck check(scene_);
    for (uint32_t index = 0; index < scene_.chunks().size(); ++index) {
      const Chunk chunk = scene_.read_chunk(index);
      check.add(chunk, index);
      for (size_t i = 0; i < chunk.node.size(); ++i) {
        const uint32_t node = chunk.node[i];
        tree_.extent[node] = chunk.record_of(i).extent;
        tree_.child_count[node] = chunk.record_of(i).child_count;
        chunk_of_[node] = index;
      }
    }
    if (!link_tiles(tree_))
      throw Error(ErrorCode::refused_input, scene_.name() +
                                                ": found counts of children that are no tree of " +
                                                std::to_string(nodes) + " nodes, expected one");
  }

  // Relative to the scene's origin.
  GaussianCloud read_tile(const Tile& tile) const {
    const std::vector<uint32_t> nodes = nodes_of_tile(tree_, tile);
    std::vector<uint32_t> chunks;
    chunks.reserve(nodes.size());
    for (const uint32_t node : nodes) chunks.push_back(chunk_of_[node]);
    std::sort(chunks.begin(), chunks.end());
    chunks.erase(std::unique(chunks.begin(), chunks.end()), chunks.end());
    GaussianCloud cloud;
    cloud.sh_degree = scene_.info().sh_degree;
    cloud.left_out_bands = scene_.info().left_out_bands;
    cloud.native = scene_.info().native;
    for (const uint32_t index : chunks) {
      const Chunk chunk = scene_.read_chunk(index);
      for (size_t i = 0; i < chunk.node.size(); ++i)
        if (std::binary_search(nodes.begin(), nodes.end(), chunk.node[i]))
          append_flat(chunk, i, cloud);
    }
    put_back_zero_bands(cloud);
    return cloud;
  }

  void write_tile(size_t index) {
    GaussianCloud cloud = read_tile(plan_[index]);
    if (options_.flat.spz_inside) centre(cloud);
    TileEntry& entry = entries_[index];
    entry.uri = name_of_tile(index);
    entry.error = kErrorOfExtent * plan_[index].error;
    entry.children = plan_[index].children;
    FlatContents contents;
    contents.sh_degree = cloud.sh_degree;
    contents.native = cloud.native;
    contents.add(cloud);
    entry.own = entry.volume = box_of(
        cloud, options_.flat.spz_inside ? slack_of_spz(contents.reach_from_origin()) : Slack{});
    const std::string path = place_(entry.uri);
    write_flat_file(path, options_.flat, contents,
                    [&](GaussianWriter& writer) { writer.append(cloud); });
    const uint64_t bytes = std::filesystem::file_size(path);
    summary_.gaussians += cloud.size();
    summary_.contents.count += cloud.size();
    summary_.contents.clamped.add(contents.clamped);
    summary_.bytes += bytes;
    summary_.largest = std::max(summary_.largest, bytes);
    // As if all tiles were at one place: steps follow the reach of each.
    for (size_t axis = 0; axis < 3; ++axis) {
      double &least = summary_.contents.least[axis], &most = summary_.contents.most[axis];
      least = std::min(least, contents.least[axis] - contents.origin[axis]);
      most = std::max(most, contents.most[axis] - contents.origin[axis]);
    }
  }

  // Children come after their parent.
  void join_volumes() {
    for (size_t i = entries_.size(); i-- > 1;)
      entries_[plan_[i].parent].volume.add(entries_[i].volume);
  }

  void write_json() {
    const std::string text = tileset_json(entries_, scene_.info().origin, options_.flat.spz_inside);
    AtomicFile file(place_("tileset.json"));
    file.write(std::as_bytes(std::span(text)));
    file.commit();
    summary_.bytes += text.size();
  }

  const SceneFile& scene_;
  const PlaceFile& place_;
  const TilesetOptions& options_;
  const Progress& progress_;
  TileTree tree_;
  std::vector<uint32_t> chunk_of_;  // by node
  std::vector<Tile> plan_;
  std::vector<TileEntry> entries_;
  TilesetSummary summary_;
};

}  // namespace

TilesetSummary export_tileset(const SceneFile& scene, const PlaceFile& place,
                              const TilesetOptions& options, const Progress& progress) {
  return TilesetExport(scene, place, options, progress).run();
}

}  // namespace voyager
