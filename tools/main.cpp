// voyager: the command line. Rendering goes through the public C ABI; baking and
// export use the runtime directly.
#include <csignal>
#include <cstdio>
#include <new>

#include "tools/commands/commands.h"
#include "tools/exit_code.h"
#include "voyager/voyager.hpp"

namespace {

int fail(int code, const std::string& message) noexcept {
  std::fputs(("voyager: " + message + "\n").c_str(), stderr);
  return code;
}

// What was printed may still wait in the buffer when the disk is full.
int finish() {
  if (std::fflush(stdout) == 0) return voyager::tools::kSuccess;
  return fail(voyager::tools::kMachine, "standard output: cannot be written to");
}

// The first argument that no command took; an option's name rather than its value.
std::string unexpected(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining(true);
  for (const std::string& argument : rest)
    if (argument.starts_with('-')) return argument;
  return rest.empty() ? "an argument" : rest.front();
}

int parse_and_run(CLI::App& app, int argc, char** argv) {
  using namespace voyager::tools;
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty())
      return fail(kBadUsage, "found no command, expected one (see --help)");
    return finish();
  } catch (const CLI::Success& request) {
    return app.exit(request);  // --help and --version
  } catch (const CLI::ExtrasError&) {
    return fail(kBadUsage, unexpected(app) + ": not part of this version (see --help)");
  } catch (const CLI::ParseError& error) {
    return fail(kBadUsage, std::string(error.what()) + " (see --help)");
  } catch (const voy::Error& error) {
    return fail(exit_code(error.result()), error.what());
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
  CLI::App app{"Voyager: city-scale 3D Gaussian scenes, baked and rendered"};
  app.name("voyager");
  app.set_version_flag("--version", VOYAGER_VERSION);
  app.require_subcommand(0, 1);
  app.footer("voyager COMMAND --help has an example of each.");
  voyager::tools::add_synth(app);
  voyager::tools::add_bake(app);
  voyager::tools::add_export(app);
  voyager::tools::add_info(app);
  voyager::tools::add_render(app);
  voyager::tools::add_bench(app);
#ifdef VOYAGER_HAS_REPORT
  voyager::tools::add_report(app);
#endif
  return parse_and_run(app, argc, argv);
} catch (...) {
  return voyager::tools::kMachine;  // no memory even for the message
}
