// What long work shows on a terminal and in a log.
#include "tools/progress_bar.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "tools/console.h"

namespace voyager::progress_bar_test {
namespace {

using namespace std::chrono_literals;
using tools::Verbosity;

// Short times in place of seconds.
constexpr tools::ProgressPace kPace{1ms, 50ms, 50ms, 100s};

// What comes out of standard error while this lives.
class Stderr {
 public:
  explicit Stderr(bool terminal) {
    int ends[2] = {-1, -1};
    const bool made = terminal ? ::openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) == 0
                               : ::pipe(ends) == 0;
    EXPECT_TRUE(made);
    from_ = ends[0];
    kept_ = ::dup(STDERR_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[1]);
  }
  // Until something was printed, however busy the machine is.
  void wait() const {
    pollfd readable{from_, POLLIN, 0};
    EXPECT_EQ(::poll(&readable, 1, 10000), 1);
  }
  // Also puts standard error back.
  std::string text() {
    std::fputs("END", stderr);
    std::string all;
    char buffer[256];
    while (all.find("END") == std::string::npos) {
      const ssize_t got = ::read(from_, buffer, sizeof buffer);
      if (got <= 0) break;
      all.append(buffer, static_cast<size_t>(got));
    }
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
    ::close(from_);
    return all.substr(0, all.find("END"));
  }

 private:
  int from_ = -1, kept_ = -1;
};

enum class Work { brief, until_shown };

std::string shown(bool terminal, Verbosity verbosity, Work work) {
  Stderr out(terminal);
  tools::set_verbosity(verbosity);
  {
    const Progress progress = tools::progress_bar(kPace);
    progress("baking", 1, 2);
    if (work == Work::until_shown) out.wait();
    progress("baking", 2, 2);
  }
  tools::set_verbosity(Verbosity::normal);
  return out.text();
}

TEST(ProgressBar, ATerminalHasABarThatGoesAway) {
  const std::string text = shown(true, Verbosity::normal, Work::until_shown);
  EXPECT_NE(text.find("\rbaking       [====================                    ]  50 %"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("\r\033[K")) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(ProgressBar, ALogHasFewPlainLines) {
  EXPECT_EQ(shown(false, Verbosity::normal, Work::until_shown), "voyager: baking: 50 %\n");
}

TEST(ProgressBar, ShortWorkAndQuietShowNothing) {
  EXPECT_EQ(shown(false, Verbosity::normal, Work::brief), "");
  EXPECT_EQ(shown(true, Verbosity::quiet, Work::brief), "");
  EXPECT_EQ(shown(false, Verbosity::quiet, Work::brief), "");
}

TEST(ProgressBar, VerboseTellsWhatAStageTook) {
  EXPECT_EQ(shown(false, Verbosity::verbose, Work::brief), "voyager: baking: 0.0 s\n");
}

}  // namespace
}  // namespace voyager::progress_bar_test
