#include "tools/commands/optimize_options.h"

#include <fmt/core.h>

#include "tools/console.h"
#include "tools/options.h"

namespace voyager::tools {
namespace {

void parse(const std::string& text, OptimizeOptions& options) {
  options.minutes = 0;
  if (text == "draft") {
    options.quality = OptimizeQuality::draft;
  } else if (text == "good") {
    options.quality = OptimizeQuality::good;
  } else if (text == "best") {
    options.quality = OptimizeQuality::best;
  } else {
    const auto minutes = parse_number(text);
    if (!minutes || !(*minutes > 0 && *minutes <= 10000))
      throw CLI::ValidationError("--optimize",
                                 "found " + text +
                                     ", expected draft, good or best, or minutes above 0 up to "
                                     "10000");
    options.quality.reset();
    options.minutes = *minutes;
  }
}

}  // namespace

OptimizeGoal OptimizeOptions::goal(uint64_t merged_nodes) const {
  if (!quality) return {.minutes = minutes};
  return {.pictures = pictures_of(*quality, merged_nodes)};
}

void add_optimize_options(CLI::App& command, OptimizeOptions& options) {
  command
      .add_option_function<std::string>(
          "--optimize", [&options](const std::string& text) { parse(text, options); },
          "Let merged Gaussians learn from pictures of the scene (docs/optimizing.md), so that "
          "cuts look better: draft, good or best, or how many minutes to take. A bake that was "
          "stopped goes on from FILE.optimize when it is run again. In memory only; where that, or "
          "a GPU's memory, is short, one part of the scene after another")
      ->type_name("QUALITY|MINUTES");
  add_backend_options(command, options.backend);
  name_group(command, "Optimizing");
}

void print_learned(const OptimizeSummary& learned) {
  for (size_t i = 0; i < learned.after.size(); ++i) {
    const HeldOut &before = learned.before[i], &after = learned.after[i];
    // In parts extents shrink when all have learned, so that what was looked at has another τ now.
    const std::string at = before.tau == after.tau ? "" : fmt::format(" at tau {:.3g}", before.tau);
    say(fmt::format(
        "tau {:.3g}: {:.1f} dB with {:.1f} % of the Gaussians, before {:.1f} dB with {:.1f} %{}; "
        "with as many, {:+.1f} dB in the view that gained least; every Gaussian {:.1f} dB\n",
        after.tau, after.cut, 100 * after.share, before.cut, 100 * before.share, at,
        learned.least_gain(i), after.leaves));
  }
}

}  // namespace voyager::tools
