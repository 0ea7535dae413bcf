#pragma once
// How a program ends: an exit status, and one line on standard error where it is not success.
#include <functional>
#include <string>

namespace host {

// The status.
int fail(const char* program, int status, const std::string& message) noexcept;

// kSuccess, or what work() threw: of Voyager's errors, the status that `voyager` would have.
int outcome_of(const char* program, const std::function<void()>& work);

}  // namespace host
