#include "tools/progress_bar.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

namespace voyager::tools {
namespace {

struct State {
  bool terminal = ::isatty(STDERR_FILENO) != 0;
  std::string stage;
  int shown = -1;  // the last step that was printed
};

// A standard error that is closed stops no work.
template <class... T>
void print(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stderr);
}

void show(State& state, const char* stage, uint64_t done, uint64_t total) {
  if (state.stage != stage) {
    state.stage = stage;
    state.shown = -1;
  }
  const int steps = state.terminal ? 40 : 4;
  const double share = total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
  const int step = static_cast<int>(share * steps);
  if (step == state.shown) return;
  state.shown = step;
  if (!state.terminal) {
    print("{}: {:3.0f} %\n", stage, share * 100);
    return;
  }
  print("\r{:<12} [{:<40}] {:3.0f} %{}", stage, std::string(static_cast<size_t>(step), '='),
        share * 100, step == steps ? "\n" : "");
}

}  // namespace

Progress progress_bar() {
  return [state = std::make_shared<State>()](const char* stage, uint64_t done, uint64_t total) {
    show(*state, stage, done, total);
  };
}

}  // namespace voyager::tools
