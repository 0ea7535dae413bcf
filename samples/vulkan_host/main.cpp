// A small engine with Vulkan: glTF meshes with depth, a Gaussian city from Voyager composited
// with them, a camera to fly and a HUD; or, offscreen, a PNG a frame.
#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

#include "camera_file.h"
#include "failure.h"
#include "files.h"
#include "mode_names.h"
#include "offscreen.h"
#include "options.h"
#include "outcome.h"
#include "placement.h"
#include "window_loop.h"

namespace host {
namespace {

constexpr char kProgram[] = "vulkan_host";
constexpr double kNear = 0.2;  // metres, as `voyager render` has it

DepthConvention convention(VoyDepthEncoding encoding) {
  if (encoding == VOY_DEPTH_ENCODING_REVERSED)
    return {encoding, kNear, std::numeric_limits<double>::infinity()};
  return {encoding, kNear, 10000};
}

VoyagerOptions voyager_options(const Options& options, const std::vector<Camera>& cameras) {
  VoyagerOptions out;
  out.scene = options.scene;
  out.tau = options.tau.value_or(out.tau);
  out.frame_time = options.time_budget.value_or(0);
  if (!cameras.empty()) out.first_frame = cameras.front().pose;
  out.memory_budget = static_cast<uint64_t>(options.budget_megabytes * 1e6);
  out.backend = options.backend;
  out.sharing = options.sharing;
  out.sync = options.sync;
  out.images = kFramesInFlight;
  return out;
}

// The sample's own mesh lies beside the program, as it is built and as it is installed.
std::string own_mesh() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path().parent_path() / "share/voyager/landmarks.gltf").string();
}

void say_what_runs(const Device& device, const VoyagerLayer& voyager) {
  const VoyVulkanCapabilities& vulkan = voyager.vulkan_capabilities();
  std::printf("%s: backend %s, sharing %s, sync %s%s%s\n", device.name().c_str(),
              backend_name(voyager.capabilities().backend), sharing_name(vulkan.sharing),
              sync_name(vulkan.sync), vulkan.why[0] ? ": " : "", vulkan.why);
  std::fflush(stdout);
}

// Of a window's frame three quarters are Voyager's; the meshes, the composite and the display's
// compositor have the rest. At half the rate Voyager has two. A CPU needs longer than any
// display's frame, so it draws at a fixed tau.
HudState hud_state(const Options& options, const Look& look, const VoyagerLayer& voyager,
                   const Window& window) {
  constexpr double kShare = 0.75;
  const double frames = options.half_rate ? 2 : 1;
  const bool on_gpu = voyager.capabilities().backend == VOY_BACKEND_CUDA;
  const bool holds_time = options.time_budget || (!options.tau && voyager.has_tree() && on_gpu);
  return {look, static_cast<float>(options.tau.value_or(3)), holds_time,
          static_cast<float>(
              options.time_budget.value_or(kShare * frames * window.frame_milliseconds()))};
}

OffscreenOptions offscreen_options(const Options& options) {
  return {options.output, options.frames, options.write_depth};
}

// No file that is read is written.
void check_outputs(const Options& options, const std::optional<Mesh>& mesh) {
  std::vector<std::string> others = {options.scene, options.camera_file};
  if (mesh) others.insert(others.end(), mesh->files.begin(), mesh->files.end());
  require_distinct(options.stats_file, others);
  if (!options.stats_file.empty()) require_writable(options.stats_file);
  others.push_back(options.stats_file);
  if (options.offscreen) prepare_folder(offscreen_options(options), others);
}

void run(const Options& options, Validation* validation) {
  // Files first: what is refused is refused before any device is made.
  std::vector<Camera> cameras;
  if (!options.camera_file.empty()) cameras = read_cameras(options.camera_file);
  std::optional<Mesh> mesh;
  if (options.mesh) mesh = read_mesh(options.mesh_file.empty() ? own_mesh() : options.mesh_file);
  check_outputs(options, mesh);

  std::optional<Glfw> glfw;
  std::optional<Presentation> presentation;
  if (!options.offscreen)
    presentation = glfw.emplace("no window (--offscreen needs none)").presentation();
  const Presentation* presents = presentation ? &*presentation : nullptr;
  const Instance instance(kProgram, validation, presents);
  const Device device(instance, presents, options.device_name);
  const DepthConvention depth = convention(options.depth);
  VoyagerLayer voyager(device, voyager_options(options, cameras), depth);
  say_what_runs(device, voyager);

  std::optional<Window> window;
  std::optional<Swapchain> swapchain;
  VkFormat colour = options.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  if (!options.offscreen) {
    window.emplace(instance.get(), "Voyager", 1280, 720);
    colour = swapchain.emplace(device, window->surface()).colour_format();
  }
  Renderer renderer(device, voyager, colour, depth, mesh ? &*mesh : nullptr,
                    place_mesh(voyager.scene(), options.mesh_place), options.half_rate);
  const Look look = {options.composite, options.mesh};
  FrameLog log(options.stats_file);
  if (options.offscreen) {
    run_offscreen(device, renderer, voyager, depth, cameras, look, offscreen_options(options), log);
  } else {
    run_window(device, *window, *swapchain, renderer, voyager, cameras,
               {options.frames, hud_state(options, look, voyager, *window)}, log);
  }
  log.write(device, voyager);
}

int parse_and_run(int argc, char** argv) {
  std::optional<Options> options;
  try {
    options = parse_options(argc, argv);
    if (!options) return kSuccess;  // --help
  } catch (const CLI::ParseError& error) {
    return fail(kProgram, kBadUsage, std::string(error.what()) + " (see --help)");
  }
  Validation validation;
  const int status =
      outcome_of(kProgram, [&] { run(*options, options->validation ? &validation : nullptr); });
  // Counted once all is destroyed.
  if (status == kSuccess && validation.messages() > 0)
    return fail(kProgram, kBadUsage,
                std::to_string(validation.messages()) + " validation messages");
  return status;
}

}  // namespace
}  // namespace host

int main(int argc, char** argv) try {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is then an error that names itself
  return host::parse_and_run(argc, argv);
} catch (...) {
  return host::kMachine;
}
