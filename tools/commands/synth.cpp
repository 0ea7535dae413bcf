#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "runtime/base/name_ending.h"
#include "runtime/base/output_path.h"
#include "runtime/scene/export/writer.h"
#include "tools/byte_size.h"
#include "tools/commands/commands.h"
#include "tools/console.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"
#include "tools/synth/city.h"

namespace voyager::tools {
namespace {

using namespace synth;

struct SynthArguments {
  CityDesc city;
  std::string what, output;
};

void generate(const CityDesc& city, GaussianWriter& writer) {
  generate_city(
      city, [&](const GaussianCloud& batch) { writer.append(batch); }, progress_bar());
  writer.finish();
}

void write_cameras(const std::string& path, const std::string& cameras) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(cameras)));
  file.commit();
}

void write_city(const SynthArguments& arguments) {
  const CityDesc& city = arguments.city;
  if (arguments.output == "-") {
    const auto sink = sink_to_stdout();
    generate(city, *write_ply(*sink, city.gaussians, city.sh_degree, false));
    return;
  }
  const std::filesystem::path path(arguments.output);
  const auto beside = [&](const char* ending) {
    return std::filesystem::path(path).replace_extension(ending).string();
  };
  const std::string cameras_path = beside(".cameras.json"), close_up_path = beside(".closeup.json");
  const bool ply = has_ending(arguments.output, ".ply");
  require_distinct({arguments.output, cameras_path, close_up_path}, {});
  for (const std::string& cameras : {cameras_path, close_up_path}) require_writable(cameras);
  AtomicFile file(arguments.output);
  if (ply) require_room(arguments.output, ply_bytes(city.gaussians, city.sh_degree));
  const auto sink = sink_to(file);
  if (ply)
    generate(city, *write_ply(*sink, city.gaussians, city.sh_degree, false));
  else
    generate(city, *write_spz(*sink, city.gaussians, city.sh_degree, largest_coordinate(city)));
  file.commit();

  write_cameras(cameras_path, city_cameras_json(city));
  write_cameras(close_up_path, city_close_up_json(city));
  say(fmt::format(
      "{}: {} Gaussians of SH degree {}, {}\n{}: cameras of a walk and a flight\n"
      "{}: cameras of a walk up to a wall and along it\n",
      arguments.output, city.gaussians, city.sh_degree,
      size_text(std::filesystem::file_size(arguments.output)), cameras_path, close_up_path));
}

std::string check_output(const std::string& path) {
  if (path == "-" || has_ending(path, ".ply") || has_ending(path, ".spz")) return {};
  return "found " + path +
         ", expected a name that ends in .ply or .spz, or - for a .ply on standard output";
}

}  // namespace

void add_synth(CLI::App& app) {
  auto arguments = std::make_shared<SynthArguments>();
  CLI::App* command =
      app.add_subcommand("synth", "Make a synthetic city, with cameras of a walk and a flight");
  command->add_option("what", arguments->what, "What to make, city")
      ->required()
      ->check([](const std::string& what) {
        return what == "city" ? "" : "found " + what + ", expected city";
      });
  add_whole_option(*command, "--gaussians", {10000, 100000000}, arguments->city.gaussians,
                   "How many Gaussians, from 10000 to 100000000")
      ->required();
  command
      ->add_option(
          "-o", arguments->output,
          "File to write, a .ply or a .spz, or - for a .ply on standard output. The cameras "
          "go to NAME.cameras.json and NAME.closeup.json beside it")
      ->required()
      ->type_name("FILE")
      ->check(check_output);
  add_whole_option(*command, "--seed", {}, arguments->city.seed,
                   "Another seed makes another city; the same arguments make the same bytes")
      ->default_str(std::to_string(arguments->city.seed));
  add_whole_option(*command, "--sh-degree", {0, 3}, arguments->city.sh_degree,
                   "Degree of the spherical harmonics, 0 to 3")
      ->default_str(std::to_string(arguments->city.sh_degree));
  name_group(*command, kCommonOptions);
  command->footer("Example: voyager synth city --gaussians 200000 -o city.ply");
  command->callback([arguments] { write_city(*arguments); });
}

}  // namespace voyager::tools
