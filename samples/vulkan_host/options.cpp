#include "options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <map>

#include "option_checks.h"

namespace host {
namespace {

// An option whose value is one of a few names.
template <class T>
void add_choice(CLI::App& app, const std::string& name, T& value,
                const std::map<std::string, T>& names, const std::string& help) {
  app.add_option_function<std::string>(
         name, [&value, names](const std::string& chosen) { value = names.at(chosen); }, help)
      ->check(CLI::IsMember(names));
}

MeshPlace parse_place(const std::string& text) {
  const std::vector<std::string> parts = CLI::detail::split(text, ',');
  std::array<double, 4> v = {};
  if (parts.size() != v.size()) throw CLI::ValidationError("--mesh-at", "expected four numbers");
  for (size_t i = 0; i < v.size(); ++i)
    if (!CLI::detail::lexical_cast(parts[i], v[i]) || !std::isfinite(v[i]))
      throw CLI::ValidationError("--mesh-at", "found " + parts[i] + ", expected a finite number");
  if (!(v[3] > 0)) throw CLI::ValidationError("--mesh-at", "expected a scale above 0");
  return {{v[0], v[1], v[2]}, v[3]};
}

void add_choices(CLI::App& app, Options& o) {
  add_choice<Composite>(
      app, "--composite", o.composite,
      {{"limit", Composite::limit}, {"test", Composite::test}, {"none", Composite::none}},
      "How meshes and splats meet: the meshes' depth limits the splats, the finished image is "
      "depth-tested, or meshes alone");
  add_choice<VoyDepthEncoding>(
      app, "--depth", o.depth,
      {{"standard", VOY_DEPTH_ENCODING_STANDARD}, {"reversed", VOY_DEPTH_ENCODING_REVERSED}},
      "This host's depth: 0 near, or 1 near and infinitely far");
  add_choice<VoyBackend>(
      app, "--backend", o.backend,
      {{"auto", VOY_BACKEND_AUTO}, {"cpu", VOY_BACKEND_CPU}, {"cuda", VOY_BACKEND_CUDA}},
      "What draws the splats");
  add_choice<VoyVulkanSharing>(app, "--sharing", o.sharing,
                               {{"auto", VOY_VULKAN_SHARING_AUTO},
                                {"device", VOY_VULKAN_SHARING_DEVICE},
                                {"host", VOY_VULKAN_SHARING_HOST}},
                               "Where the splats' image lies");
  add_choice<VoyVulkanSync>(app, "--sync", o.sync,
                            {{"auto", VOY_VULKAN_SYNC_AUTO},
                             {"timeline", VOY_VULKAN_SYNC_TIMELINE},
                             {"binary", VOY_VULKAN_SYNC_BINARY},
                             {"host", VOY_VULKAN_SYNC_HOST}},
                            "How the queue and Voyager wait for one another");
}

void add_budgets(CLI::App& app, Options& o) {
  auto* const tau = app.add_option("--tau", o.tau, "Level of detail, pixels: smaller is finer")
                        ->check(CLI::Validator(not_negative, "PX"));
  app.add_option(
         "--time-budget", o.time_budget,
         "Voyager's part of a frame: tau follows. In a window without --tau, on a GPU, "
         "three quarters of the time that its display shows a frame, or two with --half-rate")
      ->check(CLI::Validator(above_zero, "MS"))
      ->excludes(tau);
  app.add_option("--budget", o.budget_megabytes,
                 "Stream the scene: 10^6 bytes that its data may occupy")
      ->check(CLI::Validator(megabytes, "MB"));
}

void add_mesh_options(CLI::App& app, Options& o) {
  app.add_flag_callback(
      "--no-mesh", [&o] { o.mesh = false; }, "The splats alone");
  app.add_option("--mesh", o.mesh_file, "A glTF scene in place of the sample's own")
      ->type_name("FILE")
      ->excludes("--no-mesh");
  app.add_option_function<std::string>(
         "--mesh-at", [&o](const std::string& text) { o.mesh_place = parse_place(text); },
         "Where its origin stands, in the scene's axes, and metres a unit")
      ->type_name("X,Y,Z,SCALE")
      ->excludes("--no-mesh");
}

void check_together(const Options& o) {
  if (o.offscreen && o.frames == 0)
    throw CLI::ValidationError("--offscreen", "expected --frames N with it, 1 or more");
  if (o.offscreen && o.camera_file.empty())
    throw CLI::ValidationError("--offscreen", "expected --camera-file FILE with it");
  if (o.offscreen && o.output.empty())
    throw CLI::ValidationError("--offscreen", "expected -o FOLDER with it");
  if (!o.offscreen && !o.output.empty())
    throw CLI::ValidationError("-o", "expected --offscreen with it");
  if (!o.offscreen && o.write_depth)
    throw CLI::ValidationError("--write-depth", "expected --offscreen with it");
  if (!o.offscreen && o.srgb)
    throw CLI::ValidationError("--srgb", "expected --offscreen with it: a window has its format");
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv) {
  Options o;
  CLI::App app{
      "A small engine-like Vulkan host: glTF meshes with depth, and Voyager's splats among them"};
  app.name("vulkan_host");
  app.add_option("SCENE", o.scene, ".voy, or a flat scene of any format")->required();
  app.add_flag("--offscreen", o.offscreen, "No window: a PNG a frame, 0000.png and so on");
  app.add_option("--frames", o.frames, "How many; the cameras are repeated from the start")
      ->type_name("N");
  app.add_option("--camera-file", o.camera_file, "cameras.json; each has its own size")
      ->type_name("FILE");
  app.add_option("-o", o.output, "Where the PNGs go")->type_name("FOLDER");
  add_mesh_options(app, o);
  add_choices(app, o);
  add_budgets(app, o);
  app.add_option("--device", o.device_name, "The Vulkan device whose name has this in it")
      ->type_name("NAME");
  app.add_flag("--srgb", o.srgb, "Draw into an _SRGB image");
  app.add_flag(
      "--half-rate", o.half_rate,
      "Voyager draws every second frame; those between are reprojected from the one before");
  app.add_flag("--write-depth", o.write_depth,
               "Beside each PNG this host's depth at the frame's end: 0000.pfm, metres");
  app.add_option("--stats", o.stats_file, "A JSON file of what each frame took")->type_name("FILE");
  app.add_flag("--validation", o.validation,
               "Run under the validation layer, synchronisation included; exit with 1 if it "
               "reports anything");
  app.footer(
      "vulkan_host city.voy --offscreen --frames 12 --camera-file city.cameras.json -o walk");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    app.exit(request);
    return std::nullopt;
  }
  check_together(o);
  return o;
}

}  // namespace host
