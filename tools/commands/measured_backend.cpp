#include "tools/commands/measured_backend.h"

#include "runtime/base/error.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"
#include "tools/options.h"

namespace voyager::tools {

void add_backend_options(CLI::App& command, BackendChoice& choice) {
  add_choice<MeasuredBackend>(command, "--backend", choice.backend,
                              {{"auto", MeasuredBackend::automatic},
                               {"cpu", MeasuredBackend::cpu},
                               {"cuda", MeasuredBackend::cuda}},
                              "Where; auto is CUDA where there is a device");
  command
      .add_option("--sms", choice.multiprocessors,
                  "Confine CUDA to so many multiprocessors (green context)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
}

std::unique_ptr<Backend> create_backend(const BackendChoice& choice) {
  const BackendModuleOptions options{0, choice.multiprocessors, nullptr};
  if (choice.backend == MeasuredBackend::cuda) return load_backend("cuda", options);
  if (choice.backend == MeasuredBackend::automatic) {
    try {
      return load_backend("cuda", options);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::no_device) throw;
    }
  }
  if (choice.multiprocessors != 0)
    throw Error(ErrorCode::invalid_argument,
                "--sms: found the CPU backend, expected --backend cuda");
  return create_cpu_backend();
}

}  // namespace voyager::tools
