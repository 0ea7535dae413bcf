// What a bake refuses, and which way it goes.
#include <fmt/core.h>

#include <algorithm>

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/base/output_path.h"
#include "runtime/base/url.h"
#include "runtime/optimize/checkpoint.h"
#include "runtime/refine/measured.h"
#include "runtime/refine/refine.h"
#include "runtime/scene/import/importer.h"
#include "tools/byte_size.h"
#include "tools/commands/bake_arguments.h"
#include "tools/console.h"
#include "tools/counted.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

// Of all inputs together.
struct Announced {
  uint64_t gaussians = 0;
  int sh_degree = 0;
};

Announced announced_by(const Readers& readers) {
  Announced all;
  for (const auto& reader : readers) {
    all.gaussians += reader->count();
    all.sh_degree = std::max(all.sh_degree, reader->sh_degree());
  }
  return all;
}

uint64_t bytes_in_memory(const Announced& inputs, const BakeArguments& arguments) {
  return bytes_to_bake(inputs.gaussians, inputs.sh_degree) +
         (arguments.refine != 0 ? bytes_to_refine(inputs.gaussians) : 0) +
         (arguments.optimize.wanted() ? least_bytes_to_optimize(inputs.gaussians, inputs.sh_degree)
                                      : 0);
}

void print_summary(const BakeArguments& arguments, const BakeSummary& result,
                   const Stopwatch& watch) {
  say(fmt::format("{}: {}, {}, {}, {}, {}, {:.1f} s{}\n", arguments.output,
                  counted(result.gaussians, "Gaussian"), counted(result.nodes, "node"),
                  counted(result.subtrees, "subtree"), counted(result.chunks, "chunk"),
                  size_text(open_file_source(arguments.output)->size()),
                  watch.milliseconds() / 1000,
                  arguments.verify    ? ", verified"
                  : result.cells != 0 ? fmt::format(", in {} cells", result.cells)
                                      : ""));
  if (result.import.dropped() + result.import.repaired() > 0)
    say(fmt::format("{} dropped, {} repaired (voyager info {} tells which)\n",
                    counted(result.import.dropped(), "Gaussian"), result.import.repaired(),
                    arguments.output));
}

// A .hier has a tree of its own, which stays unless another is asked for.
bool keeps_tree(const BakeArguments& arguments) {
  return arguments.inputs.size() == 1 && is_hier_name(shown_path(arguments.inputs.front())) &&
         !arguments.tree_given && !arguments.placement.given();
}

void require_kept_alone(const BakeArguments& arguments) {
  const auto refuse = [&](bool given, const char* option) {
    if (given)
      throw Error(ErrorCode::invalid_argument,
                  fmt::format("{}: found {}, whose own tree is kept, expected --tree clustered "
                              "beside it, which builds another",
                              option, shown_path(arguments.inputs.front())));
  };
  refuse(arguments.refine != 0, "--refine");
  refuse(arguments.optimize.wanted(), "--optimize");
  refuse(!arguments.training_cameras.empty(), "--training-cameras");
  refuse(!arguments.work.empty(), "--work");
}

bool writes_output(const BakeArguments& arguments) {
  return arguments.step == BakeStep::all || arguments.step == BakeStep::merge;
}

// The files that this command writes outside its work folder.
std::vector<std::string> outputs_of(const BakeArguments& arguments) {
  std::vector<std::string> outputs;
  if (writes_output(arguments)) outputs.push_back(arguments.output);
  if (arguments.refine != 0) outputs.push_back(refine_file(arguments));
  if (arguments.optimize.wanted()) outputs.push_back(optimize_file(arguments));
  return outputs;
}

}  // namespace

void bake(const BakeArguments& arguments) {
  require_extension("-o", arguments.output, {".voy"});
  require_distinct(outputs_of(arguments), arguments.inputs);
  if (arguments.refine != 0 && arguments.tree != TreeKind::clustered)
    throw Error(ErrorCode::invalid_argument,
                "--refine: found --tree hierarchicalgs, expected the clustered tree: the other's "
                "extents are sides of boxes");
  if (arguments.optimize.wanted() && arguments.tree != TreeKind::clustered)
    throw Error(ErrorCode::invalid_argument,
                "--optimize: found --tree hierarchicalgs, expected the clustered tree");
  if (arguments.part && arguments.step != BakeStep::cells && arguments.step != BakeStep::encode)
    throw Error(ErrorCode::invalid_argument,
                "--part: found it without --step cells or encode, expected one of them");
  if (arguments.step != BakeStep::all && arguments.work.empty())
    throw Error(ErrorCode::invalid_argument, "--step: found no --work, expected its folder");
  arguments.placement.of(arguments.inputs.size());
  if (keeps_tree(arguments)) require_kept_alone(arguments);
  for (const std::string& output : outputs_of(arguments)) require_writable(output);
  if (arguments.refine != 0) check_kept(refine_file(arguments));
  if (arguments.optimize.wanted()) check_checkpoints(optimize_file(arguments));
  const NativeChoice native = native_choice(arguments);
  const Progress progress = progress_bar();
  const Stopwatch watch;
  if (!arguments.work.empty()) {
    const BakeSummary result = bake_from_folder(
        arguments, native, [&] { return open_inputs(arguments, native); }, progress);
    if (writes_output(arguments)) return print_summary(arguments, result, watch);
    say(fmt::format("{}: {} Gaussians in {} cells, {:.1f} s\n", arguments.work, result.gaussians,
                    result.cells, watch.milliseconds() / 1000));
    return;
  }
  Readers readers = open_inputs(arguments, native);
  const Announced inputs = announced_by(readers);
  require_room(arguments.output,
               bytes_of_scene(inputs.gaussians, inputs.sh_degree, arguments.quality));
  const uint64_t bytes = bytes_in_memory(inputs, arguments);
  if (bytes > arguments.memory * 1'000'000 && arguments.optimize.wanted())
    throw Error(ErrorCode::over_budget,
                fmt::format("--memory: found {} MB, expected at least {} with --optimize, which "
                            "bakes in memory",
                            arguments.memory, bytes / 1'000'000 + 1));
  if (keeps_tree(arguments)) {
    readers.clear();
    if (bytes > arguments.memory * 1'000'000)
      throw Error(ErrorCode::over_budget,
                  fmt::format("--memory: found {} MB, expected at least {} to keep the tree of {}; "
                              "--tree clustered builds another in less",
                              arguments.memory, bytes / 1'000'000 + 1,
                              shown_path(arguments.inputs.front())));
    return print_summary(arguments, bake_kept_tree(arguments, native, progress), watch);
  }
  if (bytes <= arguments.memory * 1'000'000)
    return print_summary(arguments, bake_in_memory(arguments, native, readers, progress), watch);
  print_summary(arguments,
                bake_from_folder(
                    arguments, native, [&] { return std::move(readers); }, progress),
                watch);
}

}  // namespace voyager::tools
