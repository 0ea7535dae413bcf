#include "tools/progress_bar.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "tools/console.h"

namespace voyager::tools {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// A thread prints, so that work that reports nothing for a while is seen to go on.
class Bar {
 public:
  explicit Bar(const ProgressPace& pace)
      : pace_(pace), printer_([this] { print_until_closed(); }) {}
  ~Bar() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    wake_.notify_all();
    printer_.join();
    if (terminal_) show_line("");
  }
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;

  void report(const char* stage, uint64_t done, uint64_t total) {
    const std::lock_guard lock(mutex_);
    const bool ends = total != 0 && done >= total;
    if (ends && stage_.empty()) return;
    if (stage_ != stage) {
      end_stage();
      stage_ = stage;
      begun_ = Clock::now();
    }
    done_ = done;
    total_ = total;
    if (ends) end_stage();
  }

 private:
  void end_stage() {
    if (stage_.empty()) return;
    if (terminal_) show_line("");
    detail(fmt::format("{}: {:.1f} s", stage_, Seconds(Clock::now() - begun_).count()));
    stage_.clear();
  }

  std::string text() const {
    const double seconds = Seconds(Clock::now() - begun_).count();
    if (total_ == 0) return fmt::format("{}: {:.0f} s", stage_, seconds);
    const double share = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    if (!terminal_) return fmt::format("{}: {:.0f} %", stage_, share * 100);
    const auto cells = static_cast<size_t>(share * 40);
    return fmt::format("{:<12} [{:<40}] {:3.0f} %  {:.0f} s", stage_, std::string(cells, '='),
                       share * 100, seconds);
  }

  void print() {
    const auto now = Clock::now();
    if (stage_.empty() || now < next_) return;
    if (terminal_) return show_line(text());
    note(text());
    next_ = now + pace_.next_line;
  }

  void print_until_closed() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, pace_.refresh, [this] { return closed_; })) print();
  }

  const ProgressPace pace_;
  const bool terminal_ = on_terminal();
  std::mutex mutex_;
  std::condition_variable wake_;
  bool closed_ = false;
  std::string stage_;  // "": no work is in progress
  uint64_t done_ = 0, total_ = 0;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point next_ = begun_ + (terminal_ ? pace_.first_bar : pace_.first_line);
  std::thread printer_;  // last: it uses the others
};

}  // namespace

Progress progress_bar(ProgressPace pace) {
  if (verbosity() == Verbosity::quiet) return [](const char*, uint64_t, uint64_t) {};
  return [bar = std::make_shared<Bar>(pace)](const char* stage, uint64_t done, uint64_t total) {
    bar->report(stage, done, total);
  };
}

}  // namespace voyager::tools
