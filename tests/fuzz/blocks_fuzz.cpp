// Any bytes of a .ply or .spz read as a bake reads them: block by block, from a file and from a
// pipe. All agree with the importer of the whole, to the bit, or all refuse.
#include <cstdint>

#include "tests/fuzz/read_blocks.h"

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

void read_all_ways(Input bytes) {
  const auto source = std::make_shared<MemorySource>("fuzz", bytes);
  const auto first = bytes.first(std::min(bytes.size(), kFormatBytes));
  const bool known = is_importable(first, ""), is_ply = known && first[0] == std::byte{'p'};
  // Of the rest .spz alone: the others have targets of their own.
  if (known && !is_ply && first[0] != std::byte{0x1f} && first[0] != std::byte{'N'}) return;
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
