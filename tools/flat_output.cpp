#include "tools/flat_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/name_ending.h"
#include "runtime/format/export_flat.h"
#include "runtime/format/extent_cut.h"
#include "runtime/lod/kept_tree.h"
#include "tools/byte_size.h"
#include "tools/console.h"
#include "tools/counted.h"
#include "tools/options.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

std::optional<Keep> parse_keep(const std::string& text) {
  if (!text.ends_with('%')) {
    const std::optional<uint64_t> count = parse_whole(text);
    return count && *count > 0 ? std::optional(Keep{0, *count}) : std::nullopt;
  }
  const std::optional<double> percent = parse_number(text.substr(0, text.size() - 1));
  return percent && *percent > 0 && *percent <= 100 ? std::optional(Keep{*percent / 100, 0})
                                                    : std::nullopt;
}

uint64_t most_kept(const Keep& keep, uint64_t leaves) {
  if (keep.count > 0) return keep.count;
  return std::max<uint64_t>(1, static_cast<uint64_t>(static_cast<double>(leaves) * keep.share));
}

void describe_share(uint64_t kept, uint64_t leaves) {
  if (leaves > 0)
    say(fmt::format("{:.2f} % of {} leaves\n",
                    100 * static_cast<double>(kept) / static_cast<double>(leaves), leaves));
}

}  // namespace

void add_flat_options(CLI::App& command, FlatArguments& arguments) {
  command
      .add_option_function<std::string>(
          "--keep",
          [&arguments](const std::string& found) {
            arguments.keep = parse_keep(found);
            if (!arguments.keep)
              throw CLI::ValidationError("--keep", "found " + found +
                                                       ", expected a share of up to 100% "
                                                       "or a number of Gaussians, 1 or more");
          },
          "Of a .voy, or of a .hier alone with convert, fewer Gaussians: a share of the leaves "
          "(25%) or how many. The tree's merged Gaussians take the place of what is left out where "
          "that is seen least")
      ->type_name("P%|N");
  add_whole_option(command, "--spz-version", {3, 4}, arguments.spz_version,
                   "Version of a .spz: 4, or 3, which more programs read (default: 4, inside of a "
                   ".glb 3)");
  command.add_flag("--spz", arguments.spz_inside,
                   "Compress a .glb: SPZ inside, about a fifth of the size "
                   "(KHR_gaussian_splatting_compression_spz_2, a draft)");
  name_group(command, "Flat files");
}

FlatOptions flat_options(const FlatArguments& arguments, const std::string& output,
                         bool writes_tilesets) {
  const std::optional<FlatFormat> format = flat_format_of(output);
  // The tiles of a tileset are .glb files.
  const bool glb =
      format == FlatFormat::glb || (writes_tilesets && has_ending(output, "tileset.json"));
  if (arguments.spz_inside && !glb)
    throw Error(ErrorCode::invalid_argument, "--spz: found -o " + output +
                                                 ", expected a name that ends in .glb" +
                                                 (writes_tilesets ? ", or tileset.json" : ""));
  if (arguments.spz_version && format != FlatFormat::spz && !arguments.spz_inside)
    throw Error(ErrorCode::invalid_argument,
                "--spz-version: found -o " + output +
                    ", expected a name that ends in .spz, or a .glb with --spz");
  FlatOptions options;
  options.spz_inside = arguments.spz_inside;
  options.spz_version = arguments.spz_version.value_or(arguments.spz_inside ? 3 : 4);
  return options;
}

void export_flat(const SceneFile& scene, const FlatArguments& arguments,
                 const std::string& output) {
  const FlatOptions options = flat_options(arguments, output);
  const uint64_t leaves = scene.info().leaf_count;
  const uint64_t most = arguments.keep ? most_kept(*arguments.keep, leaves) : leaves;
  if (most >= leaves) {  // in the input's own words and order
    describe_flat_file(output, export_leaves(scene, output, options, progress_bar()), options);
    return;
  }
  const FlatContents contents = export_extent_cut(scene, most, output, options, progress_bar());
  describe_flat_file(output, contents, options);
  describe_share(contents.count, leaves);
}

void export_kept_tree(const std::shared_ptr<const ByteSource>& source,
                      const FlatArguments& arguments, const std::string& output) {
  const FlatOptions options = flat_options(arguments, output);
  require_flat_file(output, {}, options);
  const Progress progress = progress_bar();
  const KeptTree kept = read_kept_tree(source, progress);
  for (const std::string& text : notes_of(kept)) note(fmt::format("{}: {}", source->name(), text));
  const uint64_t leaves = kept.scene.leaves.size();
  const uint64_t most = arguments.keep ? most_kept(*arguments.keep, leaves) : leaves;
  const FlatContents contents =
      export_cloud(extent_cut(kept.scene, most), output, options, progress);
  describe_flat_file(output, contents, options);
  describe_share(contents.count, leaves);
}

void describe_flat_file(const std::string& path, const FlatContents& contents,
                        const FlatOptions& options) {
  const FlatFormat format = flat_format_of(path).value();
  for (const std::string& lost : losses(format, contents, options))
    note(fmt::format("{}: {}", path, lost));
  say(fmt::format("{}: {} of SH degree {}, {}\n", path, counted(contents.count, "Gaussian"),
                  format == FlatFormat::splat ? 0 : contents.sh_degree,
                  size_text(std::filesystem::file_size(path))));
  const ImportReport& report = contents.report;
  if (report.dropped() + report.repaired() > 0)
    say(fmt::format("{} dropped, {} repaired\n", counted(report.dropped(), "Gaussian"),
                    report.repaired()));
}

}  // namespace voyager::tools
