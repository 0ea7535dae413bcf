// The files of a SOG scene without the zip, whose checksums would hide them: each is its length in
// four bytes, then its bytes. The first is meta.json; the others are handed out in turn.
#include <cstdint>
#include <cstring>

#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/sog/scene.h"
#include "tests/fuzz/import_fuzz.h"

namespace voyager::fuzz {
namespace {

using Bytes = std::span<const std::byte>;

class InputFiles final : public sog::Files {
 public:
  explicit InputFiles(Bytes input) : input_(input), rest_(input) { meta_ = next(); }

  const std::string& name() const override { return name_; }
  std::vector<std::byte> meta() const override { return meta_; }
  sog::FileBytes bytes(std::span<const std::string>) const override {
    return {{name_, input_.size()}};
  }
  std::vector<std::byte> read(const std::string&, uint64_t) const override { return next(); }

 private:
  std::vector<std::byte> next() const {
    uint32_t length = 0;
    if (rest_.size() < sizeof length) refuse(name_, 0, "files", "no more", "another");
    std::memcpy(&length, rest_.data(), sizeof length);
    rest_ = rest_.subspan(sizeof length);
    const Bytes file = rest_.first(std::min<size_t>(length, rest_.size()));
    rest_ = rest_.subspan(file.size());
    return {file.begin(), file.end()};
  }

  std::string name_ = "fuzz";
  Bytes input_;
  mutable Bytes rest_;
  std::vector<std::byte> meta_;
};

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace voyager;
  const auto bytes = std::as_bytes(std::span(data, size));
  const fuzz::MemoryLimit limit(size);
  fuzz::unless_refused([&] {
    fuzz::read_small_blocks(*sog::open_scene(std::make_unique<fuzz::InputFiles>(bytes)));
    return GaussianCloud();
  });
  return 0;
}
