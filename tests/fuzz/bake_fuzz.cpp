// A small cloud of extreme values, baked: the tree and its partition are sound, the file has them,
// and a bake in parts gives the same file. The bytes are pairs of a field and a value, from which
// one Gaussian after the other is made.
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "runtime/bake/bake.h"
#include "runtime/base/error.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/format/export_flat.h"
#include "runtime/format/writer.h"
#include "runtime/lod/build.h"
#include "runtime/lod/validate.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/sh_bands.h"
#include "tests/fuzz/memory_limit.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/small_frame.h"

namespace voyager::fuzz {
namespace {

// Gaussians: each costs milliseconds. Of cells, four of the smallest, and some.
constexpr size_t kMost = 64, kMostInCells = 600;

class Input {
 public:
  explicit Input(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  bool empty() const { return at_ >= bytes_.size(); }
  uint8_t byte() { return empty() ? 0 : bytes_[at_++]; }
  uint32_t word() {
    uint32_t word = 0;
    for (int shift = 0; shift < 32; shift += 8) word |= uint32_t{byte()} << shift;
    return word;
  }

  // An extreme value, any word at all, or an ordinary value.
  float value() {
    using Limits = std::numeric_limits<float>;
    constexpr float kExtreme[] = {0.0f,
                                  -0.0f,
                                  Limits::denorm_min(),
                                  -Limits::denorm_min(),
                                  Limits::min(),
                                  Limits::max(),
                                  Limits::lowest(),
                                  Limits::infinity(),
                                  -Limits::infinity(),
                                  Limits::quiet_NaN(),
                                  1e18f,
                                  9.99999e17f,
                                  -9.99999e17f,
                                  1e-18f,
                                  1e30f,
                                  16000.0f,
                                  -16384.5f,
                                  6.4e6f,
                                  kMinLogScale,
                                  kMaxLogScale,
                                  kMaxLogit,
                                  -kMaxLogit,
                                  -200.0f,
                                  1e-38f};
    const uint8_t code = byte();
    if (code < std::size(kExtreme)) return kExtreme[code];
    if (code < 64) return std::bit_cast<float>(word());
    return (static_cast<float>(code) - 160) / 16;
  }

 private:
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
};

struct Choices {
  explicit Choices(Input& input) {
    const uint8_t bits = input.byte();
    sh_degree = bits & 3;
    quality = bits & 4 ? Quality::compact : Quality::lossless;
    cells = (bits & 24) == 24;
    if ((bits & 24) == 8) rule.kind = TreeKind::hierarchicalgs;
    if (bits & 16) rule.block = 2, rule.exposure_block = 16;
    if (bits & 32) chunk_bytes = kMinChunkBytes;
    antialiased = (bits & 64) != 0;
    if (bits & 128)
      for (double& axis : origin) axis = 1024.0 * std::bit_cast<int32_t>(input.word());
  }

  int sh_degree;
  Quality quality;
  bool cells;  // baked in parts, too
  TreeRule rule;
  uint32_t chunk_bytes = kDefaultChunkBytes;
  bool antialiased;
  std::array<double, 3> origin{0, 0, 0};
};

// A field number beyond the last appends some copies of the Gaussian. The next starts from it.
GaussianCloud make_cloud(Input& input, const Choices& choices) {
  GaussianCloud cloud;
  cloud.sh_degree = choices.sh_degree;
  if (choices.antialiased) cloud.native = compensated_scale(kLowPass);
  cloud.origin = choices.origin;
  std::vector<float> fields(11 + 3 * static_cast<size_t>(cloud.coefficients()));
  fields[6] = 1;
  const size_t most = choices.cells ? kMostInCells : kMost;
  while (!input.empty() && cloud.size() < most) {
    const size_t field = input.byte() % (fields.size() + 4);
    if (field < fields.size()) {
      fields[field] = input.value();
      continue;
    }
    for (int copies = 1 + input.byte() % 64; copies != 0 && cloud.size() < most; --copies) {
      auto add = [&, at = fields.begin()](std::pmr::vector<float>& to, int count) mutable {
        to.insert(to.end(), at, at + count);
        at += count;
      };
      add(cloud.position, 3);
      add(cloud.log_scale, 3);
      add(cloud.rotation, 4);
      add(cloud.opacity, 1);
      add(cloud.sh, 3 * cloud.coefficients());
    }
  }
  return cloud;
}

void expect(bool right) {
  if (!right) std::abort();
}

void expect_none(const std::vector<std::string>& findings) {
  for (const std::string& finding : findings) std::fprintf(stderr, "%s\n", finding.c_str());
  expect(findings.empty());
}

bool same_bits(const std::pmr::vector<float>& a, const std::pmr::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
  });
}

void expect_same_words(const GaussianCloud& a, const GaussianCloud& b) {
  expect(a.sh_degree == b.sh_degree && a.origin == b.origin);
  expect(same_bits(a.position, b.position) && same_bits(a.log_scale, b.log_scale));
  expect(same_bits(a.rotation, b.rotation) && same_bits(a.opacity, b.opacity));
  expect(same_bits(a.sh, b.sh));
}

void draw_all(const std::shared_ptr<const Scene>& scene, Workers& workers) {
  const auto backend = create_cpu_backend();
  View view(scene, *backend, {}, std::pmr::get_default_resource(), workers);
  for (const double tau : {0.0, 3.0, 50.0}) {
    try {
      draw(view, frame_of(*scene, 1.5, tau));
    } catch (const Error& error) {
      expect(error.code() == ErrorCode::invalid_argument);  // a camera out of range
    }
  }
}

// The cloud as an input of a bake.
class CloudReader final : public BlockReader {
 public:
  explicit CloudReader(const GaussianCloud& cloud) : cloud_(cloud) {}
  const std::string& name() const override { return name_; }
  uint64_t count() const override { return cloud_.size(); }
  int sh_degree() const override { return cloud_.sh_degree; }
  NativeScale native() const override { return cloud_.native; }
  std::array<double, 3> origin() const override { return cloud_.origin; }

  RawBlock next(size_t most) override {
    RawBlock block;
    block.count = std::min(most, cloud_.size() - taken_);
    const auto place = std::as_bytes(std::span(&taken_, 1));
    block.bytes.assign(place.begin(), place.end());
    taken_ += block.count;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    size_t first = 0;
    std::memcpy(&first, block.bytes.data(), sizeof first);
    GaussianCloud part;
    part.sh_degree = cloud_.sh_degree;
    part.native = cloud_.native;
    part.origin = cloud_.origin;
    const auto take = [&](std::pmr::vector<float>& to, const std::pmr::vector<float>& from) {
      const size_t width = from.size() / cloud_.size();
      const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first * width);
      to.assign(begin, begin + static_cast<std::ptrdiff_t>(block.count * width));
    };
    take(part.position, cloud_.position);
    take(part.log_scale, cloud_.log_scale);
    take(part.rotation, cloud_.rotation);
    take(part.opacity, cloud_.opacity);
    take(part.sh, cloud_.sh);
    return part;
  }

 private:
  const std::string name_ = "fuzz";
  const GaussianCloud& cloud_;
  size_t taken_ = 0;
};

bool same_files(const std::string& a, const std::string& b) {
  const auto all = [](const std::string& path) {
    const auto source = open_file_source(path);
    std::vector<std::byte> bytes(source->size());
    source->read(0, bytes);
    return bytes;
  };
  return all(a) == all(b);
}

// `whole`: the file of a bake in memory.
void bake_in_cells(const GaussianCloud& input, const Choices& choices, const std::string& whole,
                   Workers& workers) {
  BakeInParts bake;
  bake.request = "fuzz";
  bake.output = scratch_file("parts.voy");
  bake.work = scratch_file("work");
  bake.quality = choices.quality;
  bake.chunk_bytes = choices.chunk_bytes;
  bake.memory = 1'000'000;
  bake.most_in_cell = 1;
  bake.rule = choices.rule;
  const auto open = [&] {
    std::vector<std::unique_ptr<BlockReader>> readers;
    readers.push_back(std::make_unique<CloudReader>(input));
    return readers;
  };
  bake_in_parts(bake, open, workers, {});
  expect(same_files(bake.output, whole));
}

void bake(std::span<const uint8_t> bytes) {
  static Workers workers(1);
  const MemoryLimit limit(bytes.size());
  Input input(bytes);
  const Choices choices(input);
  const GaussianCloud words = make_cloud(input, choices);
  GaussianCloud cloud = words;
  sanitise(cloud);
  leave_out_zero_bands(cloud);
  BakedScene baked;
  try {
    baked = build_tree(cloud, workers, {}, choices.rule);
  } catch (const Error& error) {
    expect(error.code() == ErrorCode::refused_input);
    return;
  }
  expect_none(validate(baked));
  const Partition partition = partition_tree(baked.tree, choices.chunk_bytes);
  expect_none(validate(partition, baked.tree));
  const std::string path = scratch_file("scene.voy");
  write_scene_file(baked, partition, path, choices.quality, workers);
  const std::shared_ptr<const ByteSource> source = open_file_source(path);
  const GaussianCloud leaves = read_leaves(SceneFile(source));
  expect(leaves.size() == cloud.size());
  if (choices.quality == Quality::lossless) expect_same_words(leaves, cloud);
  expect(leaves.native == baked.leaves.native);
  const auto scene = load_scene(source, std::pmr::get_default_resource(), workers);
  expect(scene->damaged.empty());
  draw_all(scene, workers);
  if (choices.cells && words.size() != 0) bake_in_cells(words, choices, path, workers);
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  voyager::fuzz::bake({bytes, size});
  return 0;
}
