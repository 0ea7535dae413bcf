#pragma once
#include <string>

namespace voyager::test {

// Arguments of a call, or parameters of a function, whose parenthesis is opened before `at`.
inline size_t count_arguments(const std::string& text, size_t at) {
  size_t commas = 0, depth = 1;
  bool any = false;
  for (; at < text.size() && depth > 0; ++at) {
    depth += text[at] == '(' || text[at] == '[';
    depth -= text[at] == ')' || text[at] == ']';
    commas += depth == 1 && text[at] == ',';
    any = any || (depth > 0 && text[at] != ' ');
  }
  return any ? commas + 1 : 0;
}

}  // namespace voyager::test
