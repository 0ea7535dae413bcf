// The inputs of a bake, and where their native pixel comes from.
#include <fmt/core.h>

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/open_source.h"
#include "tools/commands/bake_arguments.h"
#include "tools/console.h"
#include "tools/joined_inputs.h"
#include "tools/training_cameras.h"

namespace voyager::tools {
namespace {

Readers open_all(const std::vector<std::string>& paths) {
  if (std::count(paths.begin(), paths.end(), "-") > 1)
    throw Error(ErrorCode::invalid_argument, "input: found - more than once, expected one stream");
  Readers readers;
  for (const std::string& path : paths) {
    if (path == "-") {
      readers.push_back(open_blocks(read_stdin()));
      continue;
    }
    const std::shared_ptr<const ByteSource> source = open_source(path);
    note_left_out(*source);
    readers.push_back(open_blocks(source));
  }
  return readers;
}

}  // namespace

// The pictures are taken to have been made as small as INRIA's trainer makes them by itself.
NativeChoice native_choice(const BakeArguments& arguments) {
  NativeChoice choice;
  if (arguments.native_pixel >= 0) choice.pixel = arguments.native_pixel;
  if (arguments.training_cameras.empty()) return choice;
  for (const TrainingCamera& camera : read_training_cameras(arguments.training_cameras))
    choice.cameras.push_back(downscaled(camera, usual_downscale(camera)));
  return choice;
}

void describe(const NativePixel& found) {
  note(fmt::format(
      "training cameras: they see {} of {} Gaussians, half of them with pixels below {:.4g} m, a "
      "tenth below {:.4g} m, a tenth above {:.4g} m: {}",
      found.seen, found.looked_at, found.median, found.tenth, found.ninetieth,
      found.scale().levels > 1 ? "each block of Gaussians gets its own" : "the scene gets one"));
}

// A file that was trained with a compensated filter is drawn with that, and with no footprint
// beside it: there is nothing to choose, but where nodes learn from.
Readers open_inputs(const BakeArguments& arguments, const NativeChoice& native) {
  Readers readers = open_all(arguments.inputs);
  const bool cameras_alone = !native.cameras.empty() && !arguments.optimize.wanted();
  for (const auto& reader : readers)
    if ((native.pixel || cameras_alone) && reader->native().antialiased())
      throw Error(ErrorCode::refused_input,
                  reader->name() +
                      ": found a scene that was trained with a compensated filter, expected none "
                      "with --native-pixel, or with --training-cameras but not --optimize: it has "
                      "no footprint");
  if (!arguments.placement.given()) return readers;
  return placed(std::move(readers), arguments.placement.of(readers.size()));
}

}  // namespace voyager::tools
