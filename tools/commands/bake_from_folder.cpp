// Bakes in parts, from a work folder on disk.
#include <fmt/core.h>

#include "runtime/base/error.h"
#include "tools/commands/bake_arguments.h"
#include "tools/console.h"
#include "tools/output_paths.h"

namespace voyager::tools {

BakeSummary bake_from_folder(const BakeArguments& arguments, const NativeChoice& native,
                             const OpenInputs& open, const Progress& progress) {
  if (arguments.verify)
    throw Error(ErrorCode::unsupported,
                "--verify: found a bake in a work folder, expected one in memory: the file is "
                "compared with the whole tree");
  if (arguments.tree != TreeKind::clustered)
    throw Error(
        ErrorCode::unsupported,
        "--tree hierarchicalgs: found a bake in a work folder, expected one in memory: give more "
        "--memory and no --work, or take the clustered tree");
  if (arguments.refine != 0)
    throw Error(ErrorCode::unsupported,
                "--refine: found a bake in a work folder, expected one in memory: give more "
                "--memory and no --work, or leave it out");
  if (arguments.optimize.wanted())
    throw Error(ErrorCode::unsupported,
                "--optimize: found a bake in a work folder, expected one in memory: give more "
                "--memory and no --work, or leave it out");
  BakeInParts bake;
  bake.request =
      bake_request(arguments.inputs, arguments.quality, arguments.chunk_bytes, {}, native) +
      request_lines(arguments.placement.of(arguments.inputs.size()));
  bake.native = native;
  bake.output = arguments.output;
  // One that nobody named goes when the bake fails, too; a kill leaves it.
  bake.temporary = arguments.work.empty();
  bake.work = bake.temporary ? arguments.output + ".work" : arguments.work;
  require_outside(bake.work, {arguments.output});
  require_outside(bake.work, arguments.inputs);
  require_not_below(arguments.output, bake.work);
  bake.quality = arguments.quality;
  bake.chunk_bytes = arguments.chunk_bytes;
  bake.memory = arguments.memory * 1'000'000;
  bake.step = arguments.step;
  const Part part = arguments.part.value_or(Part{});
  bake.part = part.part;
  bake.parts = part.parts;
  Workers workers;
  BakeSummary result = bake_in_parts(bake, open, workers, progress);
  if (result.by_cameras) describe(*result.by_cameras);
  for (const std::string& name : result.left)
    note(fmt::format("{}: not removed: {} is not a file of the bake", bake.work, name));
  return result;
}

}  // namespace voyager::tools
