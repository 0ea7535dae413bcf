#pragma once
// What `voyager bench` and `voyager report` measure.
#include <memory>

#include "runtime/frame/backend.h"

namespace CLI {
class App;
}

namespace voyager::tools {

enum class MeasuredBackend { automatic, cpu, cuda };

struct BackendChoice {
  MeasuredBackend backend = MeasuredBackend::automatic;
  unsigned multiprocessors = 0;  // of CUDA; 0: all
};

// "--backend auto|cpu|cuda" and "--sms N".
void add_backend_options(CLI::App& command, BackendChoice& choice);

// automatic: CUDA where there is a device; a warning says why there is none. Throws
// Error(invalid_argument) for multiprocessors of a CPU, else as load_backend() does.
std::unique_ptr<Backend> create_backend(const BackendChoice& choice);

}  // namespace voyager::tools
