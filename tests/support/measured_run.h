#pragma once
// Runs a built program in a child with a limit, and says what it took.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::test {

// A sanitizer's own memory and time say nothing of the program's.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kMeasures = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
inline constexpr bool kMeasures = false;
#else
inline constexpr bool kMeasures = true;
#endif
#else
inline constexpr bool kMeasures = true;
#endif

struct Spent {
  int exit_code = -1;
  std::string output;    // both streams
  double megabytes = 0;  // resident, at most
  double seconds = 0;    // of processors
};

// As run_shell() takes it.
inline Spent run_measured(const std::string& shell_command) {
  const TempFolder folder;
  const std::string log = folder.file("log");
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{rlim_t{4} << 30,
                       rlim_t{4} << 30};  // of addresses, which threads reserve many of
    if (kMeasures) ::setrlimit(RLIMIT_AS, &limit);
    const int fd = ::open(log.c_str(), O_CREAT | O_WRONLY, 0600);
    ::dup2(fd, STDOUT_FILENO);
    ::dup2(fd, STDERR_FILENO);
    ::execl("/bin/sh", "sh", "-c", ("exec " + shell_command).c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  rusage usage = {};
  ::wait4(child, &status, 0, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_bytes(log),
          static_cast<double>(usage.ru_maxrss) / 1e3,
          seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

// Refused, and for no more than 64 MB and a second beyond what a run took that had little to do.
inline void expect_cheap_refusal(const Spent& found, const Spent& little) {
  EXPECT_EQ(found.exit_code, 2) << found.output;
  if (!kMeasures) return;
  EXPECT_LT(found.megabytes, little.megabytes + 64) << found.output;
  EXPECT_LT(found.seconds, little.seconds + 1) << found.output;
}

}  // namespace voyager::test
