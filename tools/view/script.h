#pragma once
// What to do in the window without a person: lines of a file, one after the other. For tests and
// for the pictures of the documentation (docs/viewer.md has the list).
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tools/view/canvas.h"
#include "tools/view/session.h"

namespace voyager::view {

class Script {
 public:
  // Throws Error(refused_input) naming file and line, Error(file_not_found).
  explicit Script(const std::string& path);
  // What --frames and --screenshot ask for; "": no picture.
  Script(size_t frames, const std::string& screenshot);

  // Once a frame: goes on for as long as nothing has to be waited for. False at the end. Throws
  // Error(timeout) where a line waits for longer than an hour.
  bool step(Session& session, Canvas& canvas);

 private:
  // True: done, go on with the next.
  using Action = std::function<bool(Session&, Canvas&)>;
  struct Line {
    std::string text;
    Action action;
  };
  using Words = std::vector<std::string>;

  static Action parse(const Words& words);
  static Action parse_wait(const Words& words);
  static Action parse_setting(const Words& words);
  static Action parse_file(const Words& words);

  std::string path_;
  std::vector<Line> lines_;
  size_t next_ = 0;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace voyager::view
