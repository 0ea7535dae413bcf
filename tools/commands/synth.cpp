#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "runtime/scene/export/writer.h"
#include "tools/commands/commands.h"
#include "tools/progress_bar.h"
#include "tools/synth/city.h"

namespace voyager::tools {
namespace {

using namespace synth;

struct Arguments {
  CityDesc city;
  std::string what, output;
};

void generate(const CityDesc& city, GaussianWriter& writer) {
  generate_city(
      city, [&](const GaussianCloud& batch) { writer.append(batch); }, progress_bar());
  writer.finish();
}

void write_city(const Arguments& arguments) {
  const CityDesc& city = arguments.city;
  if (arguments.output == "-") {
    const auto sink = sink_to_stdout();
    generate(city, *write_ply(*sink, city.gaussians, city.sh_degree, false));
    return;
  }
  const std::filesystem::path path(arguments.output);
  AtomicFile file(arguments.output);
  const auto sink = sink_to(file);
  if (path.extension() == ".ply")
    generate(city, *write_ply(*sink, city.gaussians, city.sh_degree, false));
  else
    generate(city, *write_spz(*sink, city.gaussians, city.sh_degree, largest_coordinate(city)));
  file.commit();

  const std::string cameras = city_cameras_json(city);
  const std::string cameras_path =
      std::filesystem::path(path).replace_extension(".cameras.json").string();
  AtomicFile cameras_file(cameras_path);
  cameras_file.write(std::as_bytes(std::span(cameras)));
  cameras_file.commit();
  fmt::print("{}: {} Gaussians, SH {}\n{}: a walk and a flight\n", arguments.output, city.gaussians,
             city.sh_degree, cameras_path);
}

std::string check_output(const std::string& path) {
  const auto extension = std::filesystem::path(path).extension();
  if (path == "-" || extension == ".ply" || extension == ".spz") return {};
  return "found " + path +
         ", expected a name that ends in .ply or .spz, or - for a .ply on standard output";
}

}  // namespace

void add_synth(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("synth", "Make a synthetic city, with a walk and a flight through it");
  command->add_option("what", arguments->what, "What to make: city")
      ->required()
      ->check(CLI::IsMember({"city"}));
  command->add_option("--gaussians", arguments->city.gaussians, "How many Gaussians, 1e4 to 1e8")
      ->required()
      ->check(CLI::Range(uint64_t{10000}, uint64_t{100000000}))
      ->type_name("N");
  command->add_option("--seed", arguments->city.seed, "Another seed is another city")
      ->capture_default_str();
  command->add_option("--sh-degree", arguments->city.sh_degree, "Degree of the spherical harmonics")
      ->check(CLI::Range(0, 3))
      ->type_name("D")
      ->capture_default_str();
  command
      ->add_option("-o", arguments->output,
                   "city.ply, city.spz, or - for a .ply on standard output")
      ->required()
      ->check(CLI::Validator(check_output, "FILE"));
  command->footer(
      "The same arguments give the same bytes. Cameras go to NAME.cameras.json beside the output.\n"
      "Example: voyager synth city --gaussians 200000 -o city.ply");
  command->callback([arguments] { write_city(*arguments); });
}

}  // namespace voyager::tools
