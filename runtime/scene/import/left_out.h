#pragma once
// What readers leave out of the .spz files inside another, each thing told once.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace voyager {

class LeftOut {
 public:
  // Of one .spz.
  void add(const std::vector<std::string>& things) {
    ++files_;
    for (const std::string& thing : things) add(thing, 1);
  }
  void add(const LeftOut& other) {
    files_ += other.files_;
    for (const std::string& thing : other.order_) add(thing, other.count_.at(thing));
  }
  // For people, in the order in which they were met.
  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    const std::string files = std::to_string(files_);
    for (const std::string& thing : order_) {
      const uint64_t count = count_.at(thing);
      texts.push_back(thing + (files_ == 1       ? ", of the SPZ inside"
                               : count == files_ ? ", of all " + files + " SPZ inside"
                                                 : ", of " + std::to_string(count) + " of the " +
                                                       files + " SPZ inside"));
    }
    return texts;
  }

 private:
  void add(const std::string& thing, uint64_t times) {
    uint64_t& count = count_[thing];
    if (count == 0) order_.push_back(thing);
    count += times;
  }

  uint64_t files_ = 0;
  std::map<std::string, uint64_t> count_;
  std::vector<std::string> order_;
};

}  // namespace voyager
