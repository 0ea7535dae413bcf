// Mutates what a .glb or .gltf says: values of its JSON, whose length is right again, or bytes of
// its buffer.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/fuzz/mutator.h"

namespace voyager::fuzz {
namespace {

using Json = nlohmann::json;

constexpr uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;

uint32_t word(const Bytes& bytes, size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void put(Bytes& bytes, size_t value) {
  const auto narrow = static_cast<uint32_t>(value);
  const auto* first = reinterpret_cast<const std::byte*>(&narrow);
  bytes.insert(bytes.end(), first, first + sizeof narrow);
}

struct Parts {
  Json json = Json::object();
  Bytes binary;
  bool is_binary = false;

  // False where there is no JSON to mutate.
  bool read(const Bytes& bytes) {
    is_binary = bytes.size() >= 20 && word(bytes, 0) == kMagic;
    size_t begin = is_binary ? 20 : 0, size = bytes.size() - begin;
    if (is_binary) {
      if (word(bytes, 12) > size) return false;
      size = word(bytes, 12);
      const size_t rest = begin + size;
      if (bytes.size() - rest > 8)
        binary.assign(bytes.begin() + static_cast<std::ptrdiff_t>(rest) + 8, bytes.end());
    }
    const auto* text = reinterpret_cast<const char*>(bytes.data()) + begin;
    json = Json::parse(text, text + size, nullptr, false);
    return json.is_object();
  }

  Bytes written() const {
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (is_binary) text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    if (!is_binary) return Bytes(first, first + text.size());
    Bytes bytes;
    put(bytes, kMagic), put(bytes, 2), put(bytes, 28 + text.size() + binary.size());
    put(bytes, text.size()), put(bytes, kJson);
    bytes.insert(bytes.end(), first, first + text.size());
    put(bytes, binary.size()), put(bytes, kBinary);
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    return bytes;
  }
};

void list_values(Json& json, std::vector<Json*>& values) {
  if (json.is_structured())
    for (Json& value : json) list_values(value, values);
  values.push_back(&json);
}

void mutate_text(std::string& text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  Bytes bytes(first, first + text.size());
  mutate(bytes, bytes.size() + 16);
  text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void mutate_value(Json& value, Random& random) {
  const Json edges[] = {nullptr,
                        true,
                        -1,
                        0,
                        1,
                        2,
                        3,
                        4,
                        0.5,
                        1e300,
                        5120,
                        5121,
                        5123,
                        5126,
                        252,
                        4294967295u,
                        UINT64_MAX,
                        "SCALAR",
                        "VEC3",
                        "VEC4",
                        Json::array(),
                        Json::object(),
                        {0, 1},
                        {0, 0, 0, 1}};
  if (random.once_in(3)) {
    value = edges[random.below(std::size(edges))];
  } else if (value.is_number_integer()) {
    value = value.get<int64_t>() + static_cast<int64_t>(random.below(9)) - 4;
  } else if (value.is_number()) {
    value = value.get<double>() * (static_cast<double>(random.below(9)) - 4);
  } else if (value.is_string()) {
    mutate_text(value.get_ref<std::string&>());
  } else if (value.is_array() && !value.empty()) {
    const size_t at = random.below(value.size());
    if (random.once_in(2))
      value.erase(at);
    else
      value.push_back(Json(value[at]));
  } else if (value.is_object() && !value.empty()) {
    auto field = value.begin();
    std::advance(field, static_cast<std::ptrdiff_t>(random.below(value.size())));
    value.erase(field);
  }
}

}  // namespace
}  // namespace voyager::fuzz

size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using namespace voyager::fuzz;
  Random random(seed);
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes bytes(first, first + size);
  Parts parts;
  if (random.once_in(8) || !parts.read(bytes)) {
    mutate(bytes, max_size);
  } else if (random.once_in(5) && !parts.binary.empty()) {
    mutate(parts.binary, parts.binary.size() + 16);
    bytes = parts.written();
  } else {
    for (size_t times = 1 + random.below(3); times > 0; --times) {
      std::vector<Json*> values;
      list_values(parts.json, values);
      mutate_value(*values[random.below(values.size())], random);
    }
    bytes = parts.written();
  }
  return hand_back(bytes, data, size, max_size);
}
