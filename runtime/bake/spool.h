#pragma once
// The input, sanitised, once on disk: position words in one file, which the splits read
// many times over, and the other words in another. A row is what one Gaussian has of a
// file; rows stand in the input's order.
#include <functional>
#include <memory>
#include <vector>

#include "runtime/bake/native_choice.h"
#include "runtime/bake/sealed_file.h"
#include "runtime/bake/work_files.h"
#include "runtime/bake/work_folder.h"
#include "runtime/base/progress.h"
#include "runtime/base/scratch_file.h"
#include "runtime/base/workers.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager {

// Opens the inputs of a bake, in order: their headers are read.
using OpenInputs = std::function<std::vector<std::unique_ptr<BlockReader>>()>;

// Log scale, rotation, opacity and SH.
inline size_t other_floats(int sh_degree) {
  return 8 + static_cast<size_t>(sh_coefficients(sh_degree)) * 3;
}

// Consecutive rows that were written, and are checked, together.
struct SpoolPiece {
  uint32_t first, count;
  uint64_t position_sum, other_sum;
};

// What the inputs are together.
struct SpoolInfo {
  uint32_t gaussians = 0;
  int32_t sh_degree = 0;   // the highest that is used
  int32_t row_degree = 0;  // of the inputs, and so of the rows in the spool
  NativeScale native;
  int32_t unseen_level = 0;        // BlockFootprints
  std::vector<InputLevel> inputs;  // JoinedScale's
  std::array<double, 3> source_origin{0, 0, 0};
  ImportReport import;
  std::vector<SpoolPiece> pieces;
  std::optional<NativePixel> by_cameras;  // where cameras were asked; not in the file
};

// Reads, decodes, sanitises and writes in at most `memory` bytes; then the file "spool"
// says that it is done. Inputs that differ where append() minds are refused as there,
// more Gaussians than one tree takes too. The native scale is found by
// `native`. Progress stage "reading".
SpoolInfo spool_inputs(const OpenInputs& open, const WorkFolder& folder, uint64_t memory,
                       const NativeChoice& native, Workers& workers, const Progress& progress);

SpoolInfo read_spool_info(const WorkFolder& folder);

// Field by field: between them are bytes that nobody sets.
void put(Packer& packer, const NativeScale& native);
NativeScale take_native(Unpacker& from);

// The rows of one piece. Throws Error(refused_input) where they were altered.
std::vector<float> read_positions(const ScratchFile& file, const SpoolPiece& piece);
std::vector<float> read_others(const ScratchFile& file, const SpoolPiece& piece,
                               const SpoolInfo& spool);

}  // namespace voyager
