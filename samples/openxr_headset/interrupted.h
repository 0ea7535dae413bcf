#pragma once
// SIGINT and SIGTERM: leave as if the frames were done.
#include <csignal>

namespace host {

inline volatile std::sig_atomic_t interrupted = 0;

}  // namespace host
