#include "tools/commands/measured_backend.h"

#include "runtime/base/error.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"
#include "tools/console.h"
#include "tools/options.h"

namespace voyager::tools {

void add_backend_options(CLI::App& command, BackendChoice& choice) {
  add_choice<MeasuredBackend>(command, "--backend", choice.backend,
                              {{"auto", MeasuredBackend::automatic},
                               {"cpu", MeasuredBackend::cpu},
                               {"cuda", MeasuredBackend::cuda}},
                              "What draws. auto is CUDA if there is a device for it, else the "
                              "CPU. `voyager devices` lists what this machine has");
  add_whole_option(command, "--sms", {1, 1024}, choice.multiprocessors,
                   "Use so many multiprocessors of the GPU, at least, and no others (a green "
                   "context)");
}

std::unique_ptr<Backend> create_backend(const BackendChoice& choice) {
  const BackendModuleOptions options{0, choice.multiprocessors, nullptr};
  if (choice.backend == MeasuredBackend::cuda) return load_backend("cuda", options);
  std::string left_out;
  if (choice.backend == MeasuredBackend::automatic) {
    try {
      return load_backend("cuda", options);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::no_device) throw;
      left_out = error.what();
    }
  }
  if (choice.multiprocessors != 0)
    throw Error(ErrorCode::invalid_argument,
                "--sms: found the CPU backend, expected --backend cuda");
  if (!left_out.empty()) warn("AUTO chose the CPU: " + left_out);
  return create_cpu_backend();
}

}  // namespace voyager::tools
