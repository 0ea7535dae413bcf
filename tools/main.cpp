// voyager: the command line. Rendering goes through the public C ABI; baking and
// export use the runtime directly.
#include <csignal>
#include <cstdio>
#include <new>

#include "tools/commands/commands.h"
#include "tools/console.h"
#include "tools/exit_code.h"
#include "tools/help_format.h"
#include "tools/options.h"
#include "tools/usage_error.h"
#include "voyager/voyager.hpp"

namespace {

int fail(int code, const std::string& message) noexcept {
  voyager::tools::print_error(message);
  return code;
}

// What was printed may still wait in the buffer when the disk is full.
int finish() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return voyager::tools::kSuccess;
  return fail(voyager::tools::kMachine, "standard output: cannot be written to");
}

// The names of the result and of the call are for who programs against the library.
std::string text_of(const voy::Error& error) {
  using namespace voyager::tools;
  std::string text = error.what();
  if (verbosity() == Verbosity::verbose) return text;
  return without_call(text.substr(text.find(": ") + 2));
}

int show_commands(const CLI::App& app) {
  std::fputs(app.help().c_str(), stderr);
  return voyager::tools::kBadUsage;
}

int parse_and_run(CLI::App& app, int argc, char** argv) {
  using namespace voyager::tools;
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) return show_commands(app);
    return finish();
  } catch (const CLI::Success& request) {
    // --help and --version; CLI11 does not look at what else there is.
    if (app.get_subcommands().empty() && !app.remaining().empty())
      return fail(kBadUsage, usage_error(app, CLI::ExtrasError(app.remaining())));
    app.exit(request);
    return finish();
  } catch (const CLI::ParseError& error) {
    return fail(kBadUsage, usage_error(app, error));
  } catch (const voy::Error& error) {
    return fail(exit_code(error.result()), text_of(error));
  } catch (const voyager::Error& error) {
    return fail(exit_code(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(kMachine, "out of memory");
  } catch (const std::exception& error) {
    return fail(kMachine, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  // A closed pipe and a file too large are then errors that name themselves.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"Voyager draws 3D Gaussian scenes as large as a city"};
  app.name("voyager");
  app.formatter(voyager::tools::help_format());
  app.set_help_flag("-h,--help", "Show this text");
  app.set_version_flag("--version", VOYAGER_VERSION, "Show the version");
  app.require_subcommand(0, 1);
  app.footer(
      "Example: make a city, bake its level-of-detail tree, render a picture of it\n"
      "  voyager synth city --gaussians 200000 -o city.ply\n"
      "  voyager bake city.ply -o city.voy\n"
      "  voyager render city.voy -o city.png\n\n"
      "voyager COMMAND --help explains the options of a command.");
  voyager::tools::add_synth(app);
  voyager::tools::add_bake(app);
  voyager::tools::add_convert(app);
  voyager::tools::add_export(app);
  voyager::tools::add_info(app);
  voyager::tools::add_render(app);
  voyager::tools::add_view(app);
  voyager::tools::add_bench(app);
  voyager::tools::add_report(app);
  voyager::tools::add_devices(app);
  voyager::tools::add_verbosity_options(app);
  for (CLI::App* command : app.get_subcommands({})) {
    voyager::tools::add_verbosity_options(*command);
    voyager::tools::refuse_values_of_flags(*command);
  }
  return parse_and_run(app, argc, argv);
} catch (...) {
  return voyager::tools::kMachine;  // no memory even for the message
}
