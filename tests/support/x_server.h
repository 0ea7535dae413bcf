#pragma once
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

namespace voyager::test {

// Xvfb on a display that it finds free itself; gone with this object. It does not reset after its
// last client, which the next one would find closed.
class XServer {
 public:
  XServer() {
    int ends[2];
    if (::pipe(ends) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::close(ends[0]);
      const std::string fd = std::to_string(ends[1]);
      ::execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1400x900x24", "-nolisten",
               "tcp", "-noreset", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    char digit = 0;
    while (::read(ends[0], &digit, 1) == 1 && digit != '\n') display_ += digit;
    ::close(ends[0]);
  }
  ~XServer() {
    if (process_ <= 0) return;
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  // "" where there is none.
  const std::string& display() const { return display_; }

 private:
  pid_t process_ = -1;
  std::string display_;
};

}  // namespace voyager::test
