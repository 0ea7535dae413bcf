#pragma once
#include <array>
#include <cstddef>
#include <string>

namespace voyager {

// What messages call a field, such as "frame.eyes[1].pose.position". It is spelt only where a
// message is written, so that checks that pass cost no memory. Texts outlive it (literals do).
class FieldName {
 public:
  // Implicit, so that checks take literals.
  FieldName(const char* text) : text_(text) {}  // NOLINT(google-explicit-constructor)
  FieldName(const char* list, size_t index) : text_(list), index_(index), element_(true) {}

  // A member, written with what stands before it: field + ".pose".
  FieldName operator+(const char* member) const {
    FieldName name = *this;
    name.members_.at(name.depth_++) = member;
    return name;
  }

  operator std::string() const { return str(); }  // NOLINT(google-explicit-constructor)
  std::string str() const {
    std::string text = text_;
    if (element_) text += "[" + std::to_string(index_) + "]";
    for (size_t i = 0; i < depth_; ++i) text += members_[i];
    return text;
  }

 private:
  const char* text_;
  size_t index_ = 0;
  bool element_ = false;
  size_t depth_ = 0;
  std::array<const char*, 3> members_{};
};

}  // namespace voyager
