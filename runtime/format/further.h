#pragma once
// The section of further Gaussians, after the chunks of a .voy (docs/voy-format.md): for an export
// to .hier alone, so that nothing else reads it.
#include "runtime/base/checksum.h"
#include "runtime/base/file.h"
#include "runtime/format/reader.h"
#include "runtime/format/refusal.h"
#include "runtime/scene/further_gaussians.h"

namespace voyager {

// Appends the section. There is at least one node.
void write_further(AtomicFile& file, const FurtherGaussians& further);

// Reads the section of a file, the nodes first and then the Gaussians a block at a time: it takes
// no more memory than what has been read.
class FurtherReader {
 public:
  // Of a file without the section: no nodes. `scene` outlives the object. Throws
  // Error(refused_input) where counts, length and nodes do not fit together or the file.
  explicit FurtherReader(const SceneFile& scene);

  const std::vector<FurtherCount>& nodes() const { return nodes_; }
  uint64_t gaussians() const { return gaussians_; }

  // kHierFloats each of at least one Gaussian and at most `most`, which goes on where the last call
  // ended; some are left. Valid until the next call.
  std::span<const float> next(size_t most);
  // After the last Gaussian. Throws Error(refused_input) where the checksum is wrong.
  void finish();

 private:
  void read(std::span<std::byte> bytes);
  void read_nodes(uint32_t count);

  const SceneFile& scene_;
  const Check check_;
  uint64_t at_, gaussians_ = 0, left_ = 0;
  std::vector<FurtherCount> nodes_;
  std::vector<float> block_;
  size_t taken_ = 0;  // floats of the block
  RunningChecksum sum_;
};

}  // namespace voyager
