#pragma once
// What ends the program: an exit status (as those of `voyager`) and one line.
#include <vulkan/vulkan.h>

#include <stdexcept>
#include <string>

namespace host {

enum ExitStatus { kSuccess = 0, kBadUsage = 1, kRefusedInput = 2, kDamagedChunk = 3, kMachine = 4 };

class Failure : public std::runtime_error {
 public:
  Failure(ExitStatus status, const std::string& message)
      : std::runtime_error(message), status_(status) {}
  ExitStatus status() const { return status_; }

 private:
  ExitStatus status_;
};

// Passes a success on, VK_SUBOPTIMAL_KHR and its like included.
inline VkResult check(VkResult result, const char* call) {
  if (result < 0)
    throw Failure(kMachine, std::string(call) + ": VkResult " + std::to_string(result));
  return result;
}

}  // namespace host
