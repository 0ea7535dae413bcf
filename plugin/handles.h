#pragma once
// Handles are numbers that look like pointers: generation, slot and kind. None
// is ever dereferenced, so NULL, garbage, stale and wrong-kind handles are
// told apart.
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace voyager {

enum class Kind : uint8_t { device, scene, view, target, composite };

class HandleTable;

// What a handle stands for. Children keep their device alive, and with it the
// memory that they live in.
class Object {
 public:
  explicit Object(Kind kind, std::shared_ptr<Object> device = nullptr)
      : kind_(kind), device_(std::move(device)) {}
  virtual ~Object() = default;
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  Kind kind() const { return kind_; }
  // NULL for a device.
  const std::shared_ptr<Object>& parent() const { return device_; }

 private:
  // Its handle is stale from now on; calls that use it may go on. Under the table's lock.
  virtual void removed() noexcept {}
  // The library is unloaded and the host left the object: whether it must stay as it is,
  // because its destructor would use what may be gone.
  virtual bool stays_at_unload() noexcept { return false; }

  friend class HandleTable;
  const Kind kind_;
  const std::shared_ptr<Object> device_;
  // Guarded by the table's mutex.
  uint32_t calls_ = 0;
  bool alive_ = false;
};

// All functions are thread-safe. Failures are ApiError(VOY_ERROR_INVALID_HANDLE).
class HandleTable {
 public:
  // The library's; destroyed, with what the host left and need not stay, at unload.
  static HandleTable& instance();

  HandleTable() = default;
  ~HandleTable();

  // Throws where the object's device was destroyed meanwhile.
  void* insert(std::shared_ptr<Object> object);

  // The object stays until end_call, even if its handle is destroyed meanwhile.
  std::shared_ptr<Object> begin_call(const void* handle, Kind kind);
  void end_call(Object& object) noexcept;

  // Makes the handle stale, a device's children's too, and waits until no call
  // is in flight on any of them. The handle's own object is the last of the result,
  // and the caller drops the last reference. For a child this begins a call on its
  // device, which the caller ends after that: destructors call the host's allocator.
  std::vector<std::shared_ptr<Object>> remove(const void* handle, Kind kind);

  std::vector<std::shared_ptr<Object>> children(const Object& device, Kind kind);

 private:
  struct Slot {
    uint32_t generation = 1;
    std::shared_ptr<Object> object;
  };

  size_t find(const void* handle, Kind kind) const;
  std::shared_ptr<Object> take(size_t index);

  std::mutex mutex_;
  std::condition_variable call_ended_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_;
};

}  // namespace voyager
