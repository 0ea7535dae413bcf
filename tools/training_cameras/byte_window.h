#pragma once
// Forward over a file of any size, with a small part of it in memory.
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/file.h"

namespace voyager::tools {

class ByteWindow {
 public:
  explicit ByteWindow(const ByteSource& source) : source_(source) {}

  const std::string& name() const { return source_.name(); }
  uint64_t offset() const { return start_ + at_; }
  uint64_t left() const { return source_.size() - offset(); }

  // The next bytes, at least one, unless none are left. They are valid until the next call.
  std::string_view peek();
  void skip(uint64_t count);  // at most left()
  // To behind the next `end`, appending what comes before it to `into`, if given, as far as `most`
  // bytes. False, at the end of the file, where there is none.
  bool skip_past(char end, std::string* into = nullptr, size_t most = 0);
  // A binary value, little-endian as all machines here are. Throws Error(refused_input) with the
  // offset and `what` unless it is there.
  template <class T>
  T take(const char* what) {
    T value;
    take_bytes(reinterpret_cast<char*>(&value), sizeof value, what);
    return value;
  }

 private:
  void take_bytes(char* into, size_t count, const char* what);

  const ByteSource& source_;
  std::vector<char> bytes_;  // of the file, from start_
  uint64_t start_ = 0;
  size_t at_ = 0;
};

// What a message shows of a word of the file, which may be long and no text.
inline std::string_view excerpt(std::string_view word) {
  return word.substr(0, 40);
}

// "PLACE: found FOUND, expected EXPECTED" as Error(refused_input).
[[noreturn]] void refuse_cameras(const std::string& place, const std::string& found,
                                 const std::string& expected);

}  // namespace voyager::tools
