// Any bytes read as a bake reads them: block by block, from a file and from a pipe. All agree with
// the importer of the whole, to the bit, or all refuse.
#include <bit>
#include <cstdint>

#include "runtime/scene/import/block_reader.h"
#include "tests/fuzz/import_fuzz.h"

namespace voyager::fuzz {
namespace {

using Input = std::span<const std::byte>;

constexpr size_t kBlocks[] = {1, 3, 5000};  // Gaussians

// A stream that cannot say how long it is.
class Pipe final : public ByteReader {
 public:
  explicit Pipe(Input bytes) : source_("pipe", bytes), inner_(read_source(source_)) {}
  const std::string& name() const override { return source_.name(); }
  size_t read(std::span<std::byte> into) override { return inner_->read(into); }
  std::optional<uint64_t> remaining() const override { return std::nullopt; }
  uint64_t offset() const override { return inner_->offset(); }

 private:
  MemorySource source_;
  std::unique_ptr<ByteReader> inner_;
};

void append_words(GaussianCloud& all, const GaussianCloud& block) {
  all.sh_degree = block.sh_degree;
  all.native = block.native;
  all.origin = block.origin;
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(all.position, block.position);
  add(all.log_scale, block.log_scale);
  add(all.rotation, block.rotation);
  add(all.opacity, block.opacity);
  add(all.sh, block.sh);
}

GaussianCloud read_blocks(BlockReader& reader, size_t most) {
  GaussianCloud all;
  all.sh_degree = reader.sh_degree();
  all.native = reader.native();
  for (;;) {
    const RawBlock block = reader.next(most);
    if (block.count > most) std::abort();
    if (block.count == 0) return all;
    const GaussianCloud cloud = reader.decode(block);
    if (cloud.size() != block.count || !is_complete(cloud)) std::abort();
    append_words(all, cloud);
  }
}

bool same_bits(const std::pmr::vector<float>& a, const std::pmr::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
  });
}

void expect_same(const std::optional<GaussianCloud>& a, const std::optional<GaussianCloud>& b) {
  if (a.has_value() != b.has_value()) std::abort();
  if (!a) return;
  const bool same = a->sh_degree == b->sh_degree && a->native == b->native &&
                    (a->origin == b->origin || a->size() == 0) &&
                    same_bits(a->position, b->position) && same_bits(a->log_scale, b->log_scale) &&
                    same_bits(a->rotation, b->rotation) && same_bits(a->opacity, b->opacity) &&
                    same_bits(a->sh, b->sh);
  if (!same) std::abort();
}

void read_all_ways(Input bytes) {
  const auto source = std::make_shared<MemorySource>("fuzz", bytes);
  const auto first = bytes.first(std::min(bytes.size(), kFormatBytes));
  const bool known = is_importable(first, ""), is_ply = known && first[0] == std::byte{'p'};
  if (known && first[0] == std::byte{'P'}) return;  // a .sog: it has a target of its own
  const auto whole = unless_refused([&] {
    const MemoryLimit limit(bytes.size());
    const auto reader = read_source(*source);
    return is_ply  ? import_ply(*reader, {})
           : known ? import_spz(*reader, {})
                   : import_gaussians(*reader);
  });
  for (const size_t most : kBlocks) {
    const MemoryLimit limit(bytes.size());
    expect_same(whole, unless_refused([&] { return read_blocks(*open_blocks(source), most); }));
  }
  const MemoryLimit limit(bytes.size());
  const auto piped = unless_refused(
      [&] { return read_blocks(*open_blocks(std::make_unique<Pipe>(bytes)), kBlocks[1]); });
  if (is_ply || piped) expect_same(whole, piped);
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  voyager::fuzz::read_all_ways(std::as_bytes(std::span(data, size)));
  return 0;
}
