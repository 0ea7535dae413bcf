#pragma once
// The frame of every entry point: floating-point mode, objects in use, and no
// exception past it.
#include <memory>
#include <vector>

#include "plugin/field_name.h"
#include "plugin/handles.h"
#include "plugin/objects.h"
#include "plugin/result.h"
#include "runtime/base/floating_point_mode.h"

namespace voyager {

// Marks the objects that one call uses, so that destruction waits for it.
class Call {
 public:
  Call() = default;
  ~Call() {
    for (Object* object : in_use_) HandleTable::instance().end_call(*object);
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // Throws ApiError(VOY_ERROR_INVALID_HANDLE), ApiError(VOY_ERROR_DEVICE_LOST).
  template <class T>
  std::shared_ptr<T> use(typename T::Handle handle) {
    make_room();
    std::shared_ptr<Object> object = HandleTable::instance().begin_call(handle, T::kKind);
    in_use_.push_back(object.get());
    if (device_of(*object).abandoned)
      throw ApiError(VOY_ERROR_DEVICE_LOST,
                     "device: found a device with a frame that never finished, expected it to be "
                     "destroyed");
    enter(*object);
    return std::static_pointer_cast<T>(std::move(object));
  }

  // The same for a handle that is in a field, which the message then names.
  template <class T>
  std::shared_ptr<T> use(typename T::Handle handle, const FieldName& field) {
    try {
      return use<T>(handle);
    } catch (const ApiError& error) {
      throw ApiError(error.result(), field.str() + ": " + error.what());
    }
  }

  // Makes the handle stale (HandleTable::remove); NULL is none. Whoever destroys the
  // device waits until this call ends, so the objects must be gone by then.
  template <class T>
  std::vector<std::shared_ptr<Object>> remove(typename T::Handle handle) {
    if (handle == nullptr) return {};
    make_room();
    auto removed = HandleTable::instance().remove(handle, T::kKind);
    if (Object* device = removed.back()->parent().get()) in_use_.push_back(device);
    enter(*removed.back());
    return removed;
  }

  // This thread's message, to the log of the device whose objects the call uses, if any.
  void log_error() const noexcept {
    if (in_use_.empty()) return;
    const KeptMessage message;
    device_of(*in_use_.front()).log.write(VOY_LOG_LEVEL_ERROR, message.text());
  }

 private:
  // For one object more, so that noting it cannot fail once it is in use.
  void make_room() {
    if (in_use_.size() == in_use_.capacity()) in_use_.reserve(2 * in_use_.size() + 4);
  }
  static DeviceObject& device_of(Object& object) {
    return static_cast<DeviceObject&>(object.parent() ? *object.parent() : object);
  }
  // The device of the call's first object; all are of one.
  void enter(Object& object) {
    if (!context_) context_ = device_of(object).backend->enter();
  }

  std::vector<Object*> in_use_;
  std::shared_ptr<void> context_;  // the host's, restored at the end
};

// body(Call&) -> VoyResult.
template <class Body>
VoyResult guarded(const char* function, const Body& body) noexcept {
  const FloatingPointMode mode;
  Call call;
  try {
    return body(call);
  } catch (...) {
    const VoyResult result = translate_exception(function);
    call.log_error();
    return result;
  }
}

}  // namespace voyager
