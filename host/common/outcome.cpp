#include "outcome.h"

#include <cstdio>
#include <new>
#include <voyager/voyager.hpp>

#include "failure.h"

namespace host {
namespace {

ExitStatus status_of(VoyResult result) {
  switch (result) {
    case VOY_ERROR_INVALID_ARGUMENT:
    case VOY_ERROR_UNSUPPORTED:
      return kBadUsage;
    case VOY_ERROR_FILE_NOT_FOUND:
    case VOY_ERROR_REFUSED_INPUT:
      return kRefusedInput;
    case VOY_ERROR_DAMAGED_CHUNK:
      return kDamagedChunk;
    default:
      return kMachine;
  }
}

}  // namespace

int fail(const char* program, int status, const std::string& message) noexcept {
  std::fputs((std::string(program) + ": " + message + "\n").c_str(), stderr);
  return status;
}

int outcome_of(const char* program, const std::function<void()>& work) {
  try {
    work();
    return kSuccess;
  } catch (const Failure& failure) {
    return fail(program, failure.status(), failure.what());
  } catch (const voy::Error& error) {
    return fail(program, status_of(error.result()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(program, kMachine, "out of memory");
  } catch (const std::exception& error) {
    return fail(program, kMachine, error.what());
  }
}

}  // namespace host
