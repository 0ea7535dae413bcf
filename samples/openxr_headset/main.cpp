// A Gaussian city on an OpenXR headset: both eyes of every frame from one cut, walked through
// with thumbsticks.
#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "ground.h"
#include "interrupted.h"
#include "mode_names.h"
#include "outcome.h"
#include "visit.h"

namespace host {
namespace {

constexpr char kProgram[] = "openxr_headset";
constexpr std::chrono::milliseconds kAfterLoss(100);  // a runtime may lose session after session

struct Validations {
  Validation vulkan;
  XrValidation xr;
};

std::string say_what_runs(const Runtime& runtime, const Graphics& graphics,
                          const VoyagerLayer& voyager) {
  const VoyVulkanCapabilities& vulkan = voyager.vulkan_capabilities();
  std::string modes = std::string(runtime.view_count() > kEyes ? "two pictures an eye, " : "") +
                      "backend " + backend_name(voyager.capabilities().backend) + ", sharing " +
                      sharing_name(vulkan.sharing) + ", sync " + sync_name(vulkan.sync);
  std::printf("%s, %s: %s%s%s\n", runtime.name().c_str(), graphics.name().c_str(), modes.c_str(),
              vulkan.why[0] ? ": " : "", vulkan.why);
  std::fflush(stdout);
  return modes;
}

VoyagerOptions voyager_options(const Journey& journey) {
  const Options& options = journey.options;
  VoyagerOptions out = {options.scene,       options.tau,
                        options.time_budget, static_cast<uint64_t>(options.budget_megabytes * 1e6),
                        std::nullopt,        options.quad_views ? 2u : 1u};
  if (!journey.cameras.empty()) out.first_frame = journey.cameras.front().pose;
  return out;
}

Traveller start(const Journey& journey, const VoyagerLayer& voyager) {
  return journey.cameras.empty() ? Traveller(stand_on_ground(voyager.device(), voyager.scene()))
                                 : Traveller(journey.cameras);
}

// Sessions of one instance, one after the other as they are lost. True: the last one ended well.
// False: what hangs on the instance, or on its headset, is of no use any more.
bool visit(Journey& journey, Validations* validations) try {
  Runtime runtime(journey.options.quad_views, validations ? &validations->xr : nullptr);
  const Graphics graphics(runtime, validations ? &validations->vulkan : nullptr);
  const auto opening = std::chrono::steady_clock::now();
  VoyagerLayer voyager(graphics, voyager_options(journey));
  journey.patience.excuse(std::chrono::steady_clock::now() - opening);
  const Input input(runtime);
  journey.modes = say_what_runs(runtime, graphics, voyager);
  if (!journey.traveller) journey.traveller = start(journey, voyager);
  for (;;) {
    try {
      Visit(runtime, graphics, input, voyager, journey).run();
      journey.detail = voyager.summary();
      return true;
    } catch (const Lost& lost) {
      journey.statistics.lost();
      if (journey.finished() || interrupted) return true;
      std::fprintf(stderr, "%s: starting again\n", lost.what());
      journey.patience.check(lost.what());
      std::this_thread::sleep_for(kAfterLoss);
      if (lost.kind() == Lost::instance || !runtime.find_headset_again()) return false;
    }
  }
} catch (const Lost& lost) {
  if (interrupted) return false;
  if (!journey.traveller) throw Failure(kMachine, lost.what());  // there never was one
  journey.patience.check(lost.what());
  return false;
}

// Of what was recorded before a failure, which is the one to be told.
void save_cameras(const Journey& journey) noexcept try {
  if (journey.recorder) journey.recorder->write_cameras();
} catch (const std::exception&) {
}

void run(const Options& options, Validations* validations) {
  Journey journey(options);
  try {
    while (!visit(journey, validations) && !interrupted)
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
  } catch (...) {
    save_cameras(journey);
    throw;
  }
  if (journey.recorder) journey.recorder->write_cameras();
  std::printf("%s; %s%s%s\n", journey.statistics.summary().c_str(), journey.detail.c_str(),
              journey.detail.empty() ? "" : "; ", journey.modes.c_str());
}

int parse_and_run(int argc, char** argv) {
  std::optional<Options> options;
  try {
    options = parse_options(argc, argv);
    if (!options) return kSuccess;  // --help
  } catch (const CLI::ParseError& error) {
    return fail(kProgram, kBadUsage, std::string(error.what()) + " (see --help)");
  }
  std::optional<Validations> validations;
  if (options->validation) validations.emplace();
  const int status =
      outcome_of(kProgram, [&] { run(*options, validations ? &*validations : nullptr); });
  // Counted once all is destroyed.
  const uint64_t messages =
      validations ? validations->vulkan.messages() + validations->xr.messages() : 0;
  if (status == kSuccess && messages > 0)
    return fail(kProgram, kBadUsage, std::to_string(messages) + " validation messages");
  return status;
}

void interrupt(int number) {
  host::interrupted = 1;
  std::signal(number, SIG_DFL);  // the next one does not wait for the runtime
}

}  // namespace
}  // namespace host

int main(int argc, char** argv) try {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is then an error that names itself
  std::signal(SIGINT, host::interrupt);
  std::signal(SIGTERM, host::interrupt);
  setenv("XR_LOADER_DEBUG", "none", 0);  // what fails is said once, here
  return host::parse_and_run(argc, argv);
} catch (...) {
  return host::kMachine;
}
