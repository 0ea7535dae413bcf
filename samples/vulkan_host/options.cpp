#include "options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <map>

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

std::string not_negative(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0) return {};
  return "found " + text + ", expected a number, 0 or more";
}

// From a byte to what 64 bits of them can count; 0 is no limit.
std::string megabytes(const std::string& text) {
  constexpr double kLeast = 1e-6, kMost = 1e12;
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && (value == 0 || (value >= kLeast && value <= kMost)))
    return {};
  return "found " + text + ", expected 0, or a number from 10^-6 to 10^12";
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
  app.add_option("--tau", o.tau, "Level of detail, pixels: smaller is finer")
      ->check(CLI::Validator(not_negative, "PX"));
  app.add_option("--budget", o.budget_megabytes, "10^6 bytes that scene data may occupy")
      ->check(CLI::Validator(megabytes, "MB"));
  app.add_option("--device", o.device_name, "The Vulkan device whose name has this in it")
      ->type_name("NAME");
  app.add_flag("--srgb", o.srgb, "Draw into an _SRGB image");
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
