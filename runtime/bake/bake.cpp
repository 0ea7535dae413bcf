#include "runtime/bake/bake.h"

#include <algorithm>
#include <filesystem>

#include "runtime/bake/for_cells.h"
#include "runtime/bake/join.h"
#include "runtime/bake/merged.h"
#include "runtime/base/error.h"
#include "runtime/base/output_path.h"
#include "runtime/format/writer.h"
#include "runtime/lod/build.h"

namespace voyager {
namespace {

// Bytes a Gaussian takes as words in the input.
uint64_t word_bytes(int sh_degree) {
  return (3 + other_floats(sh_degree)) * sizeof(float);
}

uint32_t largest_of(const std::vector<uint32_t>& sizes) {
  return *std::max_element(sizes.begin(), sizes.end());
}

std::string megabytes(uint64_t bytes) {
  return std::to_string(bytes / 1000000 + 1) + " MB";
}

// The other steps share the folder.
bool alone(const BakeInParts& bake) {
  return bake.step != BakeStep::cells && bake.step != BakeStep::encode;
}

// The other steps have nothing to do in a folder that they made.
bool begins(const BakeInParts& bake) {
  return bake.step == BakeStep::all || bake.step == BakeStep::split;
}

class Baker {
 public:
  Baker(const BakeInParts& bake, const OpenInputs& open, Workers& workers, const Progress& progress)
      : bake_(bake),
        open_(open),
        workers_(workers),
        progress_(progress),
        folder_(bake.work, bake.request, alone(bake), bake.temporary || !begins(bake)) {}

  BakeSummary run() {
    if (alone(bake_) && folder_.has(kMerged)) {
      const std::optional<BakeSummary> merged = read_merged(folder_, bake_.output);
      if (merged && bake_.step != BakeStep::split) return finish(*merged);
      folder_.drop_all();  // of what is left nothing can be trusted
    }
    if (!folder_.has(kSplitDone) && !split()) return bake_whole();
    split_ = read_split_info(folder_, bake_.rule);
    for (const char* name : {kPositionRows, kOtherRows, kSpoolDone}) folder_.drop(name);
    if (bake_.step == BakeStep::split) return summary();
    if (bake_.step != BakeStep::encode) build_cells();
    if (bake_.step == BakeStep::cells) return summary();
    require_all_built();
    const BakePlan plan(
        split_.cell_level, bake_.chunk_bytes,
        [&](uint32_t cell) { return read_cell_shape(cell, folder_); }, workers_);
    const BakedScene top = build_top(split_, plan, folder_, workers_);
    encode_cells(plan, top);
    if (bake_.step == BakeStep::encode) return summary(plan);
    join(plan, top);
    return finish(summary(plan));
  }

 private:
  // Says what failed for want of space, and how much it takes.
  template <class Action>
  void in_space(uint64_t bytes, const std::string& what, const Action& action) {
    require_room({folder_.room(bytes, what)});
    try {
      action();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::io) throw;
      throw Error(ErrorCode::io, std::string(error.what()) + " (" + what + " takes " +
                                     megabytes(bytes) + " in " + folder_.path() + ")");
    }
  }

  // False where the scene is too small for cells: then it stays in the spool.
  bool split() {
    const bool spooled = folder_.has(kSpoolDone);
    if (!begins(bake_))
      if (!spooled || deepest_cell_level(read_spool_info(folder_).gaussians, bake_.rule) != 0)
        throw Error(ErrorCode::invalid_argument,
                    folder_.path() + ": found no finished split, expected --step split before");
    const SpoolInfo spool = spooled ? read_spool_info(folder_) : read_inputs();
    const uint32_t level = choose_level(spool);
    if (level == 0) return false;
    const std::array<double, 3> origin = origin_of(spool, folder_);
    folder_.expect_cells(uint32_t{1} << (2 * level));
    const SplitTree tree = find_medians(spool, level, kd_rule(bake_.rule), folder_, origin,
                                        bake_.memory / 2, workers_, progress_);
    in_space(spool.gaussians * (word_bytes(spool.sh_degree) + 4), "sorting the Gaussians", [&] {
      distribute(spool, tree, origin, folder_, bake_.memory / 2, workers_, progress_);
    });
    return true;
  }

  SpoolInfo read_inputs() {
    folder_.drop_all();
    auto readers = open_();
    uint64_t count = 0;
    int sh_degree = 0;
    for (const auto& reader : readers) {
      count += reader->count();
      sh_degree = std::max(sh_degree, reader->sh_degree());
    }
    SpoolInfo spool;
    const uint64_t bytes = count * word_bytes(sh_degree);
    if (bake_.step == BakeStep::all)
      require_room({{bake_.output, bytes_of_scene(count, sh_degree, bake_.quality), "the scene"},
                    folder_.room(bytes, "a copy of the inputs")});
    in_space(bytes, "a copy of the inputs", [&] {
      spool = spool_inputs([&] { return std::move(readers); }, folder_, bake_.memory / 2,
                           bake_.native, workers_, progress_);
    });
    by_cameras_ = spool.by_cameras;
    return spool;
  }

  // As few cells as keep all threads busy and fit into the memory.
  uint32_t choose_level(const SpoolInfo& spool) {
    const uint32_t deepest = deepest_cell_level(spool.gaussians, bake_.rule);
    const auto threads = static_cast<uint64_t>(workers_.count());
    for (uint32_t level = 1; level <= deepest; ++level) {
      const uint64_t largest = largest_of(cell_sizes(spool.gaussians, level, bake_.rule));
      if (bake_.most_in_cell != 0) {
        if (largest <= bake_.most_in_cell || level == deepest) return level;
        continue;
      }
      const bool enough = (uint64_t{1} << (2 * level)) >= 4 * threads;
      if (enough && cells_at_once(largest, spool.sh_degree) >= threads) return level;
    }
    return deepest;
  }

  uint64_t cells_at_once(uint64_t largest_cell, int sh_degree) const {
    return bake_.memory / 5 * 3 / bytes_to_bake(largest_cell, sh_degree);
  }

  size_t lanes() {
    const uint64_t largest = largest_of(split_.cell_sizes);
    const uint64_t fit = cells_at_once(largest, split_.spool.sh_degree);
    if (fit == 0 && bake_.most_in_cell == 0)
      throw Error(ErrorCode::over_budget,
                  folder_.path() + ": found --memory of " + megabytes(bake_.memory) +
                      ", expected at least " +
                      megabytes(bytes_to_bake(largest, split_.spool.sh_degree) / 3 * 5) +
                      " for its cells of " + std::to_string(largest) + " Gaussians");
    return static_cast<size_t>(
        std::clamp<uint64_t>(fit, 1, static_cast<uint64_t>(workers_.count())));
  }

  // The cells of this part that have no file of that name.
  std::vector<uint32_t> cells_without(std::string (*name)(uint32_t)) const {
    std::vector<uint32_t> cells;
    const uint64_t begin = uint64_t{split_.cells()} * bake_.part / bake_.parts;
    const uint64_t end = uint64_t{split_.cells()} * (bake_.part + 1) / bake_.parts;
    for (uint64_t cell = begin; cell < end; ++cell)
      if (!folder_.has(name(static_cast<uint32_t>(cell))))
        cells.push_back(static_cast<uint32_t>(cell));
    return cells;
  }

  void build_cells() {
    const std::vector<uint32_t> cells = cells_without(cell_tree_name);
    // A child count a node, of which a leaf has up to three, an index, an exposure and a footprint
    // a leaf; the topmost nodes of each cell.
    const uint64_t bytes = split_.spool.gaussians * uint64_t{10} +
                           cells.size() * (1 + kChildren) * uint64_t{sizeof(NodeRow)};
    in_space(bytes, "layouts of cells", [&] {
      for_cells(cells, lanes(), workers_, progress_, "merging", [&](uint32_t cell) {
        build_cell(split_, cell, bake_.rule, bake_.native.cameras, folder_, workers_);
      });
    });
  }

  void require_all_built() const {
    for (uint32_t cell = 0; cell < split_.cells(); ++cell)
      if (!folder_.has(cell_tree_name(cell)))
        throw Error(ErrorCode::invalid_argument, folder_.path() + ": found no tree of cell " +
                                                     std::to_string(cell) +
                                                     ", expected --step cells of all parts before");
  }

  void encode_cells(const BakePlan& plan, const BakedScene& top) {
    const std::vector<uint32_t> cells = cells_without(cell_chunks_name);
    // The rows of each cell go when its chunks are there: those in work are what is more, and, of
    // lossless ones, what is merged.
    const uint64_t words = word_bytes(split_.spool.sh_degree);
    const size_t at_once = lanes();
    uint64_t bytes =
        std::min(at_once, cells.size()) * largest_of(split_.cell_sizes) * uint64_t{2} * words;
    if (bake_.quality == Quality::lossless)
      for (const uint32_t cell : cells)
        bytes += split_.cell_sizes[cell] * (words * 7 / 6 + 2 * sizeof(NodeRecord));
    in_space(bytes, "chunks of cells", [&] {
      for_cells(cells, at_once, workers_, progress_, "encoding", [&](uint32_t cell) {
        encode_cell(split_, plan, top, bake_.quality, cell, folder_, workers_);
      });
    });
  }

  void join(const BakePlan& plan, const BakedScene& top) {
    uint64_t bytes = plan.chunk_count() * sizeof(ChunkEntry);
    for (uint32_t cell = 0; cell < plan.cells(); ++cell)
      bytes += std::filesystem::file_size(folder_.file(cell_chunks_name(cell)));
    require_room(bake_.output, bytes);
    try {
      join_cells(split_, plan, top, bake_.quality, folder_, bake_.output, workers_, progress_);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::io) throw;
      throw Error(ErrorCode::io, std::string(error.what()) + " (" + bake_.output + " takes " +
                                     megabytes(bytes) + ")");
    }
  }

  // Of a scene too small for cells; only at the end, since there are no parts.
  BakeSummary bake_whole() {
    const SpoolInfo spool = read_spool_info(folder_);
    BakeSummary result;
    result.gaussians = spool.gaussians;
    result.import = spool.import;
    if (bake_.step != BakeStep::all && bake_.step != BakeStep::merge) return result;
    const std::vector<uint8_t> levels = levels_of(spool.inputs);
    const BakedScene baked = build_tree(read_cloud(spool), workers_, progress_, bake_.rule,
                                        {bake_.native.cameras, spool.unseen_level, levels});
    const Partition partition = partition_tree(baked.tree, bake_.chunk_bytes);
    write_scene_file(baked, partition, bake_.output, bake_.quality, workers_, progress_);
    result.nodes = baked.tree.size();
    result.subtrees = partition.subtrees.size();
    result.chunks = partition.chunk_count();
    return finish(result);
  }

  // The scene is there. Without the note a bake that is killed now would only make it once more.
  BakeSummary finish(BakeSummary result) {
    try {
      note_merged(folder_, bake_.output, result);
    } catch (const Error&) {
    }
    result.left = folder_.remove();
    result.by_cameras = by_cameras_;
    return result;
  }

  GaussianCloud read_cloud(const SpoolInfo& spool) const {
    const ScratchFile positions = ScratchFile::open(folder_.file(kPositionRows));
    const ScratchFile others = ScratchFile::open(folder_.file(kOtherRows));
    GaussianCloud cloud;
    cloud.sh_degree = spool.sh_degree;
    cloud.left_out_bands = spool.row_degree - spool.sh_degree;
    cloud.native = spool.native;
    cloud.origin = spool.source_origin;
    cloud.report = spool.import;
    const size_t width = other_floats(spool.sh_degree);
    for (const SpoolPiece& piece : spool.pieces) {
      const std::vector<float> position = read_positions(positions, piece);
      const std::vector<float> other = read_others(others, piece, spool);
      cloud.position.insert(cloud.position.end(), position.begin(), position.end());
      for (auto row = other.begin(); row != other.end();
           row += static_cast<std::ptrdiff_t>(width)) {
        cloud.log_scale.insert(cloud.log_scale.end(), row, row + 3);
        cloud.rotation.insert(cloud.rotation.end(), row + 3, row + 7);
        cloud.opacity.push_back(row[7]);
        cloud.sh.insert(cloud.sh.end(), row + 8, row + static_cast<std::ptrdiff_t>(width));
      }
    }
    return cloud;
  }

  BakeSummary summary() const {
    BakeSummary result;
    result.gaussians = split_.spool.gaussians;
    result.import = split_.spool.import;
    result.cells = split_.cells();
    result.by_cameras = by_cameras_;
    return result;
  }
  BakeSummary summary(const BakePlan& plan) const {
    BakeSummary result = summary();
    result.nodes = plan.tiers().node_count();
    result.subtrees = plan.tiers().tier_begin.back();
    result.chunks = plan.chunk_count();
    return result;
  }

  const BakeInParts& bake_;
  const OpenInputs& open_;
  Workers& workers_;
  const Progress& progress_;
  WorkFolder folder_;
  SplitInfo split_;
  std::optional<NativePixel> by_cameras_;
};

}  // namespace

uint64_t bytes_to_bake(uint64_t gaussians, int sh_degree) {
  // Words of leaves and of 7/6 of a merged Gaussian each, 53 bytes a node, layout and
  // sources; the rest is what is encoded and what allocators keep.
  return gaussians * (word_bytes(sh_degree) * 13 / 6 + 150);
}

uint64_t bytes_of_scene(uint64_t gaussians, int sh_degree, Quality quality) {
  const uint64_t rest = static_cast<uint64_t>(sh_coefficients(sh_degree) - 1) * 3;
  // A city has 2.3 nodes a Gaussian; 82 and 144 bytes at degrees 0 and 3, lossless 269 and 684.
  return gaussians * (quality == Quality::compact ? 40 + rest * 7 / 10 : 130 + rest * 9 / 2);
}

BakeSummary bake_in_parts(const BakeInParts& bake, const OpenInputs& open, Workers& workers,
                          const Progress& progress) {
  return Baker(bake, open, workers, progress).run();
}

}  // namespace voyager
