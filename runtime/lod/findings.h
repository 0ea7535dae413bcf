#pragma once
#include <string>
#include <vector>

namespace voyager {

inline std::string name_of(size_t node, const char* what) {
  return "node " + std::to_string(node) + ", " + what;
}

// What a validator has found so far, up to a limit.
class Findings {
 public:
  explicit Findings(size_t limit) : limit_(limit) {}

  bool full() const { return messages_.size() >= limit_; }

  void add(const std::string& where, const std::string& found, const std::string& expected) {
    if (!full()) messages_.push_back(where + ": found " + found + ", expected " + expected);
  }
  template <class Found, class Expected>
  void check_equal(const std::string& where, Found found, Expected expected) {
    if (found != expected) add(where, std::to_string(found), std::to_string(expected));
  }

  std::vector<std::string> take() { return std::move(messages_); }

 private:
  size_t limit_;
  std::vector<std::string> messages_;
};

}  // namespace voyager
