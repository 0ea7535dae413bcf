#pragma once
// A bake that holds a part of the scene at a time: the same file, to the byte, that
// build_tree(), partition_tree() and write_scene_file() give, in memory of a given size,
// from a work folder in which it goes on after a kill at any moment (docs/baking.md).
//
//   split    inputs -> spool -> splits above the cells -> rows of each cell
//   cells    rows of a cell -> the layout of its tree, its topmost nodes (each cell alone)
//   encode   layouts of all cells -> the plan; their roots -> the top; of a cell rows,
//            layout and top -> chunks (each alone)
//   merge    top and chunks of all cells -> scene.voy
#include "runtime/bake/spool.h"
#include "runtime/format/layout.h"
#include "runtime/lod/tree_rule.h"

namespace voyager {

enum class BakeStep { all, split, cells, encode, merge };

struct BakeInParts {
  // What is baked: a work folder is one request's. Lines of text.
  std::string request;
  std::string output;      // the .voy
  std::string work;        // the folder: made, and removed when the output is there
  bool temporary = false;  // the folder goes when the bake that made it fails, too
  Quality quality = Quality::compact;
  uint32_t chunk_bytes = kDefaultChunkBytes;
  uint64_t memory = 0;  // bytes that scene data may take at a time, about
  // all: what of split, cells, encode and merge is still to do. merge: the same, but for
  // the split. The others: that step alone, of part `part` of `parts` of the cells.
  BakeStep step = BakeStep::all;
  uint32_t part = 0, parts = 1;
  uint32_t most_in_cell = 0;  // Gaussians; 0: what memory and threads ask for
  NativeChoice native;
  TreeRule rule;  // of a clustered tree: no other is baked in parts
};

struct BakeSummary {
  uint64_t gaussians = 0;
  uint64_t nodes = 0, subtrees = 0, chunks = 0;  // 0 until all cells are built
  ImportReport import;
  uint32_t cells = 0;               // 0: baked in one piece
  std::vector<std::string> left{};  // in the work folder, by others: for these it is still there
  std::optional<NativePixel> by_cameras{};  // where this call read the inputs and asked cameras
};

// `open` is called where the folder has not yet all of the inputs. Throws
// Error(refused_input) as importers and build_tree() do, and for a folder that is
// another request's, has files of somebody else, or was altered; Error(invalid_argument) for a step
// before its time; Error(io) where the disk is full, saying how much is needed; Error(over_budget)
// where memory does not do.
BakeSummary bake_in_parts(const BakeInParts& bake, const OpenInputs& open, Workers& workers,
                          const Progress& progress);

// The lines of a request. `inputs` are paths, URLs, or - for standard input, of which
// nothing can be told; files count with size and time of change, and so do those that
// they refer to (files_beside.h); URLs count with size. Throws Error(file_not_found), for a URL
// what open_source() does, and for a file that may refer to others what open_blocks() does.
std::string bake_request(const std::vector<std::string>& inputs, Quality quality,
                         uint32_t chunk_bytes, const TreeRule& rule = {},
                         const NativeChoice& native = {});

// Bytes that baking in memory takes at most, about.
uint64_t bytes_to_bake(uint64_t gaussians, int sh_degree);

// Bytes of the scene, at least: half of what a synthetic city's takes. More than that nobody knows
// before the bake.
uint64_t bytes_of_scene(uint64_t gaussians, int sh_degree, Quality quality);

}  // namespace voyager
