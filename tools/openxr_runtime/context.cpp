#include "context.h"

#include <cstdio>

namespace test_runtime {

namespace {

// The report of an instance that was never destroyed.
struct AtExit {
  ~AtExit() {
    if (!context().instance) return;
    run().report.remark("exit", run().frame(), "an XrInstance was not destroyed");
    try {
      run().write();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "voyager_test_runtime: %s\n", error.what());
    }
  }
};

}  // namespace

Context& context() {
  static Context& the = *new Context;
  static const AtExit at_exit;
  return the;
}

Run& run() {
  return *context().run;
}

void remark(const std::string& what) {
  const char* function = context().function;
  run().report.remark(function, run().frame(function), what);
}

XrResult start_call(const char* function) {
  context().function = function;
  if (!context().run) return XR_SUCCESS;
  run().report.called(function);
  return run().failure(function);
}

XrResult end_call(const char* function, const Refusal& refusal) noexcept {
  try {
    if (context().run && refusal.violation)
      run().report.broken(function, refusal.result, run().frame(function), refusal.what);
    else if (refusal.result != XR_ERROR_SIZE_INSUFFICIENT)
      std::fprintf(stderr, "voyager_test_runtime: %s: %s\n", function, refusal.what.c_str());
  } catch (const std::exception& error) {
    return end_call(function, error);
  }
  return refusal.result;
}

XrResult end_call(const char* function, const std::exception& error) noexcept {
  std::fprintf(stderr, "voyager_test_runtime: %s: %s\n", function, error.what());
  return XR_ERROR_RUNTIME_FAILURE;
}

}  // namespace test_runtime
