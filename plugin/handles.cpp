#include "plugin/handles.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <new>
#include <string>

#include "plugin/result.h"

namespace voyager {
namespace {

static_assert(sizeof(void*) == 8, "a handle packs a generation, a slot and a kind in 64 bits");

// generation << 32 | slot << 8 | kind << 4 | kMark. The mark is odd, so no
// pointer to an aligned object passes for a handle.
constexpr uint64_t kMark = 0x5;
constexpr size_t kMaxSlots = size_t{1} << 24;

const char* name(Kind kind) {
  switch (kind) {
    case Kind::device:
      return "device";
    case Kind::scene:
      return "scene";
    case Kind::view:
      return "view";
    case Kind::target:
      return "target";
    case Kind::composite:
      return "composite";
  }
  return "object";
}

// What a call ends: what is opened is closed, what is created is destroyed.
const char* ended(Kind kind) {
  return kind == Kind::scene ? "closed" : "destroyed";
}

[[noreturn]] void fail(Kind expected, const std::string& found) {
  throw ApiError(VOY_ERROR_INVALID_HANDLE, std::string(name(expected)) + ": found " + found +
                                               ", expected a " + name(expected) +
                                               " handle that is not " + ended(expected));
}

std::string hexadecimal(uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace

HandleTable::~HandleTable() {
  bool left = false;
  for (Slot& slot : slots_) {
    if (!slot.object) continue;
    if (slot.object->stays_at_unload())
      left = true;
    else
      slot.object.reset();
  }
  // Here nobody destroys them, and a leak checker still finds them.
  using Slots = decltype(slots_);
  alignas(Slots) static std::byte stay[sizeof(Slots)];
  if (left) new (stay) Slots(std::move(slots_));
}

size_t HandleTable::find(const void* handle, Kind kind) const {
  if (handle == nullptr) fail(kind, "NULL");
  const uint64_t value = reinterpret_cast<uintptr_t>(handle);
  const uint64_t found_kind = (value >> 4) & 0xf, index = (value >> 8) & (kMaxSlots - 1);
  const uint64_t generation = value >> 32;
  const bool issued = (value & 0xf) == kMark && found_kind <= uint64_t(Kind::composite) &&
                      index < slots_.size() && generation != 0 &&
                      generation <= slots_[index].generation;
  if (!issued) fail(kind, hexadecimal(value) + ", which is no handle of this library");
  if (found_kind != uint64_t(kind))
    fail(kind, std::string("a ") + name(static_cast<Kind>(found_kind)) + " handle");
  const Slot& slot = slots_[index];
  if (generation != slot.generation || !slot.object)
    fail(kind, std::string("the handle of a ") + name(kind) + " that was " + ended(kind));
  if (slot.object->kind() != kind)
    fail(kind, hexadecimal(value) + ", which is no handle of this library");
  return index;
}

void* HandleTable::insert(std::shared_ptr<Object> object) {
  const std::lock_guard lock(mutex_);
  if (object->parent() && !object->parent()->alive_)
    fail(Kind::device, "the handle of a device that was destroyed during the call");
  if (free_.empty()) {
    if (slots_.size() == kMaxSlots) throw std::bad_alloc();
    // Room for every slot, so that take() never allocates.
    free_.reserve(slots_.size() + 1);
    slots_.emplace_back();
    free_.push_back(static_cast<uint32_t>(slots_.size() - 1));
  }
  const uint64_t index = free_.back();
  free_.pop_back();
  Slot& slot = slots_[index];
  object->alive_ = true;
  const uint64_t value = uint64_t{slot.generation} << 32 | index << 8 |
                         static_cast<uint64_t>(object->kind()) << 4 | kMark;
  slot.object = std::move(object);
  // An opaque number, never followed.
  return reinterpret_cast<void*>(value);  // NOLINT(performance-no-int-to-ptr)
}

std::shared_ptr<Object> HandleTable::begin_call(const void* handle, Kind kind) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Object> object = slots_[find(handle, kind)].object;
  ++object->calls_;
  return object;
}

void HandleTable::end_call(Object& object) noexcept {
  const std::lock_guard lock(mutex_);
  if (--object.calls_ == 0 && !object.alive_) call_ended_.notify_all();
}

std::shared_ptr<Object> HandleTable::take(size_t index) {
  Slot& slot = slots_[index];
  slot.object->alive_ = false;
  slot.object->removed();
  // A slot whose generations are used up is retired, so that no handle comes back.
  if (slot.generation != UINT32_MAX) {
    ++slot.generation;
    free_.push_back(static_cast<uint32_t>(index));
  }
  return std::move(slot.object);
}

std::vector<std::shared_ptr<Object>> HandleTable::remove(const void* handle, Kind kind) {
  std::unique_lock lock(mutex_);
  const size_t index = find(handle, kind);
  std::vector<std::shared_ptr<Object>> taken;
  taken.reserve(slots_.size());
  const Object* removed = slots_[index].object.get();
  if (removed->parent()) ++removed->parent()->calls_;
  for (size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].object && slots_[i].object->parent().get() == removed) taken.push_back(take(i));
  taken.push_back(take(index));
  call_ended_.wait(lock, [&] {
    return std::all_of(taken.begin(), taken.end(), [](const auto& o) { return o->calls_ == 0; });
  });
  return taken;
}

std::vector<std::shared_ptr<Object>> HandleTable::children(const Object& device, Kind kind) {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Object>> found;
  for (const Slot& slot : slots_)
    if (slot.object && slot.object->parent().get() == &device && slot.object->kind() == kind)
      found.push_back(slot.object);
  return found;
}

}  // namespace voyager
