#pragma once
// Images of another API that a backend writes where they are: memory and semaphores by file
// descriptor (opaque ones, of Linux).
#include <chrono>
#include <cstdint>
#include <vector>

#include "runtime/base/file_descriptor.h"

namespace voyager {

enum class ColorFormat;

// How long a call waits for a signal that the host promised.
inline constexpr std::chrono::seconds kHostPatience{10};

struct ExternalMemory {
  FileDescriptor fd;
  uint64_t size = 0, offset = 0;  // of the memory, of what is meant in it; bytes
  bool dedicated = false;
};

// With optimal tiling, a mip level, and the ring's layers.
struct ExternalImage {
  ExternalMemory memory;
  bool color_attachment = false;  // the other API may draw to it
};

enum class ExternalSync { none, binary, timeline };

struct ExternalSlot {
  ExternalImage color, depth;
  ExternalMemory depth_limit;         // binary32, tightly packed, layer after layer
  FileDescriptor released, rendered;  // timelines: of the first slot only
};

struct ExternalRingDesc {
  ColorFormat format;
  uint32_t width = 0, height = 0, layers = 1;
  bool depth = false, depth_limit = false;
  ExternalSync sync = ExternalSync::none;
  std::vector<ExternalSlot> slots;
};

// What a backend can do with descriptors from the device that it draws on.
struct ExternalSupport {
  bool images = false, timelines = false, binaries = false;
};

// The backend's side of it. Destroyed only once it is idle.
class ExternalRing {
 public:
  virtual ~ExternalRing() = default;
  // No frame into it is in flight.
  virtual bool idle() const = 0;
  // Until it is. Throws Error(device_lost).
  virtual void wait() const = 0;
  // With a host that left frames without their release, once the ring goes. After five times as
  // long its frames are given up.
  virtual std::chrono::milliseconds patience_at_end() const { return std::chrono::seconds(2); }
};

// Where a frame goes, and what it waits for and signals, where the ring has semaphores.
struct ExternalTarget {
  ExternalRing* ring = nullptr;
  uint32_t slot = 0, layer = 0;
  bool limited = false;  // by the ring's own depth limits, which FrameInput.limits encodes
  bool waits = false, signals = false;
  uint64_t wait_value = 0, signal_value = 0;  // of timelines
};

}  // namespace voyager
