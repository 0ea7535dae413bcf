#pragma once
// The one lock, and what it guards. Every call of the application's holds it from start to end;
// xrWaitFrame lets go while it waits.
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <new>

#include "handles.h"
#include "run.h"

namespace test_runtime {

struct Context {
  std::mutex mutex;
  std::condition_variable changed;  // a frame was begun, or a session ended
  Handles handles;
  std::unique_ptr<Run> run;   // from the first xrCreateInstance on
  bool instance = false;      // there is one
  const char* function = "";  // the current call
};

// Lives as long as the process: at its end the application's Vulkan is gone, so that nothing of it
// may be destroyed then.
Context& context();
// That of the script; not before xrCreateInstance.
Run& run();

// Shown in the report for the current call.
void remark(const std::string& what);

XrResult start_call(const char* function);
XrResult end_call(const char* function, const Refusal& refusal) noexcept;
XrResult end_call(const char* function, const std::exception& error) noexcept;

// Every function of the API: counted, failed where the script says so, refusals reported.
template <class Body>
XrResult call(const char* function, const Body& body) noexcept {
  std::unique_lock lock(context().mutex);
  try {
    const XrResult scripted = start_call(function);
    return scripted == XR_SUCCESS ? body(lock) : scripted;
  } catch (const Refusal& refusal) {
    return end_call(function, refusal);
  } catch (const std::bad_alloc&) {
    return XR_ERROR_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    return end_call(function, error);
  }
}

}  // namespace test_runtime
