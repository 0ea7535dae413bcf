// Sources whose size is a claim: what they make the reader allocate follows the bytes that come.
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "runtime/scene/hier_format.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/json_value.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::claimed_size_test {
namespace {

// Bytes at some places, zeros elsewhere.
class ClaimedSource final : public ByteSource {
 public:
  ClaimedSource(std::string name, uint64_t size) : name_(std::move(name)), size_(size) {}
  template <class T>
  void put(uint64_t offset, const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    for (size_t i = 0; i < bytes.size(); ++i) bytes_[offset + i] = bytes[i];
  }
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return size_; }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    check_range(*this, offset, into.size());
    for (size_t i = 0; i < into.size(); ++i) {
      const auto found = bytes_.find(offset + i);
      into[i] = found == bytes_.end() ? std::byte{0} : found->second;
    }
  }

 private:
  std::string name_;
  uint64_t size_;
  std::map<uint64_t, std::byte> bytes_;
};

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// One node of 2^31 - 1 Gaussians, half a terabyte: a bit for each would be 268 MB.
TEST(ClaimedSize, AHierOfManyGaussiansTakesAsMuchAsItsNodes) {
  constexpr int32_t kMost = INT32_MAX;
  const HierLayout layout(kMost, 1);
  ClaimedSource source("claimed.hier", layout.end);
  source.put(0, kMost);
  source.put(layout.node_count, int32_t{1});
  source.put(layout.nodes, HierNode{0, -1, kMost - 1, 1, 0, 0, 0});
  const long before = peak_kilobytes();
  const auto reader = open_blocks(std::make_shared<ClaimedSource>(source));
  EXPECT_EQ(reader->count(), 1u);
  EXPECT_EQ(reader->next(10).count, 1u);
  EXPECT_LT(peak_kilobytes() - before, 64 * 1024);
}

TEST(ClaimedSize, JsonIsHeldToABound) {
  for (const char* name : {"lod-meta.json", "meta.json", "tileset.json", "a.gltf"}) {
    ClaimedSource source(name, kMostJsonBytes + 1);
    source.put(0, '{');
    const std::string message =
        test::refusal_of([&] { open_blocks(std::make_shared<ClaimedSource>(source)); });
    EXPECT_EQ(message, std::string(name) +
                           ": offset 0: JSON: found 67108865 bytes, expected at most 67108864");
  }
}

std::string repeated(const std::string& value, size_t count) {
  std::string text = "[" + value;
  text.reserve(count * (value.size() + 1) + 1);
  for (size_t i = 1; i < count; ++i) text += "," + value;
  return text + "]";
}

TEST(ClaimedSize, JsonOfTooManyValuesIsRefusedBeforeItIsHeld) {
  constexpr size_t kCount = 2'200'000;
  for (const std::string value : {"{}", " [ ] ", "{\"a\":[0]}"}) {
    const std::string text = repeated(value, kCount);
    const long before = peak_kilobytes();
    const std::string message = test::refusal_of([&] { parse_json("a.gltf", 20, text); });
    EXPECT_LT(peak_kilobytes() - before, 1024) << value;
    const size_t in_each = value[0] == '{' && value.size() > 2 ? 3 : 1;
    EXPECT_EQ(message, "a.gltf: offset 20: JSON: found " + std::to_string(kCount * in_each + 1) +
                           " values, expected at most 2097152");
  }
}

TEST(ClaimedSize, JsonOfAsManyValuesAsLargeTilesetsHaveIsRead) {
  const std::string tile =
      R"({"boundingVolume":{"box":[1,2,3,4,5,6,7,8,9,10,11,12]},"geometricError":0.5,)"
      R"("content":{"uri":"t, [{].glb"}})";
  EXPECT_EQ(parse_json("tileset.json", 0, repeated(tile, 60'000)).size(), 60'000u);
  EXPECT_EQ(parse_json("a", 0, repeated("0", kMostJsonValues - 1)).size(), kMostJsonValues - 1);
  EXPECT_NE(test::refusal_of([] { parse_json("a", 0, repeated("0", kMostJsonValues)); }), "");
}

}  // namespace
}  // namespace voyager::claimed_size_test
