#pragma once
// The device that a backend works on: all of it, or a part of its multiprocessors.
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "runtime/frame/backend.h"

namespace voyager::cuda {

// The context that is current to this thread; it is so again once the result is gone.
std::shared_ptr<void> keep_context();

class CodeTables;

class Device {
 public:
  // multiprocessors: 0 for all, else at least so many, through a green context (CUDA
  // 12.5): the hardware grants them in groups.
  // Throws Error(no_device), Error(unsupported).
  Device(int ordinal, unsigned multiprocessors);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // What this thread calls from now on goes to this device. Cheap.
  void use() const;
  // The same for what is the whole device's: other APIs' memory and semaphores.
  void use_whole() const;
  bool is_part() const { return context_ != nullptr; }
  // For destructors: what fails has failed before.
  void use_quietly() const noexcept;

  // What coded scenes are restored with: one for all that hold it. The device is in use().
  std::shared_ptr<const CodeTables> code_tables() const;

  int ordinal() const { return ordinal_; }
  const std::string& name() const { return name_; }
  unsigned multiprocessors() const { return multiprocessors_; }
  uint64_t memory_bytes() const { return memory_bytes_; }  // of the whole card
  const std::array<uint8_t, 16>& uuid() const { return uuid_; }
  // What it takes of another API's on the same card, as the driver says.
  ExternalSupport external_support() const;
  // From its clocks: lane-instructions of the multiprocessors in use, bytes of the whole card.
  DeviceRates rates() const;

 private:
  void make_green_context(unsigned multiprocessors);

  int ordinal_;
  std::string name_;
  std::array<uint8_t, 16> uuid_;
  unsigned multiprocessors_ = 0;
  uint64_t memory_bytes_ = 0;
  void* green_ = nullptr;    // CUgreenCtx
  void* context_ = nullptr;  // its CUcontext; null for the whole device
  mutable std::mutex tables_mutex_;
  mutable std::weak_ptr<const CodeTables> tables_;
};

}  // namespace voyager::cuda
