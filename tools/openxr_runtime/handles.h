#pragma once
// The objects to which the application holds handles. A handle is never used twice, so that a
// handle of a destroyed object is recognised. Call everything with the runtime's lock held.
#include <cstdint>
#include <map>
#include <memory>

#include "refusal.h"

namespace test_runtime {

struct Object {
  explicit Object(Object* of) : parent(of) {}
  virtual ~Object() = default;
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  Object* const parent;  // nullptr for an instance
  uint64_t handle = 0;
};

class Handles {
 public:
  template <class Handle>
  Handle add(std::unique_ptr<Object> object) {
    object->handle = next_;
    objects_[next_] = std::move(object);
    next_ += 0x10;
    return handle_of<Handle>(next_ - 0x10);
  }

  // The live object of type T with this handle. `name` stands in the refusal if there is none.
  template <class T, class Handle>
  T& find(Handle handle, const char* name) const {
    const auto found = objects_.find(number_of(handle));
    T* object = found == objects_.end() ? nullptr : dynamic_cast<T*>(found->second.get());
    if (!object)
      violation(XR_ERROR_HANDLE_INVALID,
                std::string(name) + ": found no live handle of that type, expected one");
    return *object;
  }

  // Destroys the object's children first, the youngest of them at the start. Does nothing for a
  // handle without an object.
  void destroy(uint64_t handle);
  size_t children(const Object& object) const;  // live ones, without theirs

  template <class T, class Visit>
  void each(const Visit& visit) const {
    for (const auto& item : objects_)
      if (T* object = dynamic_cast<T*>(item.second.get())) visit(*object);
  }

  template <class Handle>
  static Handle handle_of(uint64_t number) {
    return reinterpret_cast<Handle>(number);  // NOLINT(performance-no-int-to-ptr)
  }
  template <class Handle>
  static uint64_t number_of(Handle handle) {
    return reinterpret_cast<uint64_t>(handle);
  }

 private:
  std::map<uint64_t, std::unique_ptr<Object>> objects_;
  uint64_t next_ = 0x7e570000;
};

}  // namespace test_runtime
