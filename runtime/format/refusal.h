#pragma once
#include <cstdint>
#include <string>

#include "runtime/base/error.h"
#include "runtime/base/file.h"

namespace voyager {

// Refusals name the file and the byte where it went wrong.
class Check {
 public:
  explicit Check(const ByteSource& source) : source_(source) {}

  [[noreturn]] void refuse(uint64_t offset, const std::string& found,
                           const std::string& expected) const {
    throw Error(ErrorCode::refused_input, source_.name() + ": offset " + std::to_string(offset) +
                                              ": found " + found + ", expected " + expected);
  }
  void equal(uint64_t offset, const char* field, uint64_t found, uint64_t expected) const {
    if (found != expected)
      refuse(offset, std::string(field) + " " + std::to_string(found), std::to_string(expected));
  }
  void at_most(uint64_t offset, const char* field, uint64_t found, uint64_t most) const {
    if (found > most)
      refuse(offset, std::string(field) + " " + std::to_string(found),
             "at most " + std::to_string(most));
  }
  void that(bool holds, uint64_t offset, const char* found, const char* expected) const {
    if (!holds) refuse(offset, found, expected);
  }

 private:
  const ByteSource& source_;
};

}  // namespace voyager
