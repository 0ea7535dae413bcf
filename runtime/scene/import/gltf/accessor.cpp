#include "runtime/scene/import/gltf/accessor.h"

#include <algorithm>

#include "runtime/scene/import/load.h"

namespace voyager::gltf {
namespace {

Component component_of(const JsonValue& json) {
  const uint64_t value = json.whole(kMostIndex);
  for (const Component c : {Component::i8, Component::u8, Component::i16, Component::u16,
                            Component::u32, Component::f32})
    if (static_cast<uint64_t>(c) == value) return c;
  json.refuse("5120, 5121, 5122, 5123, 5125 or 5126");
}

size_t width_of(const JsonValue& json) {
  const std::string& type = json.text();
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  json.refuse("SCALAR, VEC2, VEC3 or VEC4");
}

uint64_t stride_of(const JsonValue& view, size_t element) {
  const uint64_t stride = view.whole_or("byteStride", 0, kMostIndex);
  if (stride == 0) return element;
  if (stride < element || stride > 252)
    view["byteStride"].refuse("0, or " + std::to_string(element) + " to 252");
  return stride;
}

void place(File& file, const JsonValue& json, Accessor& accessor) {
  const JsonValue view = json["bufferView"];
  accessor.bytes = file.view(view);
  accessor.stride = static_cast<size_t>(
      stride_of(file.json()["bufferViews"][view.whole(kMostIndex)], accessor.element()));
  const uint64_t offset = json.whole_or("byteOffset", 0, UINT64_MAX);
  if (offset > accessor.bytes.size)
    json["byteOffset"].refuse("at most " + std::to_string(accessor.bytes.size));
  accessor.bytes.offset += offset;
  accessor.bytes.size -= offset;
  const uint64_t room = accessor.bytes.size < accessor.element()
                            ? 0
                            : (accessor.bytes.size - accessor.element()) / accessor.stride + 1;
  if (accessor.count > room)
    json["count"].refuse("at most " + std::to_string(room) + ", what its bytes hold");
}

}  // namespace

double Accessor::number(std::span<const std::byte> element, size_t i) const {
  const std::byte* at = element.subspan(i * bytes_of(component), bytes_of(component)).data();
  switch (component) {
    case Component::f32:
      return static_cast<double>(load<float>(at));
    case Component::u32:
      return load<uint32_t>(at);
    case Component::i8:
      return normalised ? std::max(load<int8_t>(at) / 127.0, -1.0) : load<int8_t>(at);
    case Component::u8:
      return load<uint8_t>(at) / (normalised ? 255.0 : 1.0);
    case Component::i16:
      return normalised ? std::max(load<int16_t>(at) / 32767.0, -1.0) : load<int16_t>(at);
    case Component::u16:
      return load<uint16_t>(at) / (normalised ? 65535.0 : 1.0);
  }
  return 0;
}

void Accessor::read(uint64_t first, std::span<std::byte> into) const {
  if (bytes.source)
    bytes.source->read(bytes.offset + first * stride, into);
  else
    std::fill(into.begin(), into.end(), std::byte{0});
}

Accessor read_accessor(File& file, const JsonValue& index) {
  const JsonValue json = file.json()["accessors"][index.whole(kMostIndex)];
  if (json.has("sparse")) json.refuse("a sparse accessor", "one without: none is read");
  Accessor accessor;
  accessor.component = component_of(json["componentType"]);
  accessor.width = width_of(json["type"]);
  accessor.count = json["count"].whole(UINT64_MAX);
  accessor.normalised = json.has("normalized") && json["normalized"].flag();
  accessor.stride = accessor.element();
  if (json.has("bufferView")) place(file, json, accessor);
  return accessor;
}

}  // namespace voyager::gltf
