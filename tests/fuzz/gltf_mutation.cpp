#include <string>

#include "tests/fuzz/json_mutation.h"

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

}  // namespace

bool mutate_gltf(Bytes& bytes, Random& random) {
  Parts parts;
  if (!parts.read(bytes)) return false;
  if (!parts.binary.empty() && random.once_in(5))
    mutate(parts.binary, parts.binary.size() + 16);
  else
    mutate_json(parts.json, random);
  bytes = parts.written();
  return true;
}

}  // namespace voyager::fuzz
