#pragma once
// What `voyager bake` was asked, and its two ways: in memory, and from a work folder.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bake/bake.h"
#include "runtime/lod/build.h"
#include "tools/commands/optimize_options.h"
#include "tools/placement.h"

namespace voyager::tools {

// K/N
struct Part {
  uint32_t part = 0, parts = 1;
};

struct BakeArguments {
  std::vector<std::string> inputs;
  Placement placement;
  std::string output;
  Quality quality = Quality::compact;
  uint32_t chunk_bytes = kDefaultChunkBytes;
  TreeKind tree = TreeKind::clustered;
  bool tree_given = false;
  uint32_t refine = 0;  // views
  OptimizeOptions optimize;
  double native_pixel = -1;  // metres; below 0: not given
  std::string training_cameras;
  bool verify = false;
  uint64_t memory = 0;  // MB
  std::string work;
  BakeStep step = BakeStep::all;
  std::optional<Part> part;
};

using Readers = std::vector<std::unique_ptr<BlockReader>>;

// Of all inputs, in their places. Refuses a footprint for a scene that was trained without one.
Readers open_inputs(const BakeArguments& arguments, const NativeChoice& native);
NativeChoice native_choice(const BakeArguments& arguments);
// Tells what training cameras see.
void describe(const NativePixel& found);

// What was measured for --refine so far.
std::string refine_file(const BakeArguments& arguments);
// What was learned for --optimize so far.
std::string optimize_file(const BakeArguments& arguments);

BakeSummary bake_in_memory(const BakeArguments& arguments, const NativeChoice& native,
                           const Readers& readers, const Progress& progress);
// The tree of a .hier as it is.
BakeSummary bake_kept_tree(const BakeArguments& arguments, const NativeChoice& native,
                           const Progress& progress);
BakeSummary bake_from_folder(const BakeArguments& arguments, const NativeChoice& native,
                             const OpenInputs& open, const Progress& progress);

void bake(const BakeArguments& arguments);

}  // namespace voyager::tools
