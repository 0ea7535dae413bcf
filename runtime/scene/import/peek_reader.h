#pragma once
// A stream whose next bytes can be read without consuming them.
#include <vector>

#include "runtime/base/file.h"

namespace voyager {

class PeekReader final : public ByteReader {
 public:
  // `inner` must outlive the reader.
  explicit PeekReader(ByteReader& inner) : inner_(inner) {}

  // The next `count` bytes, or fewer at the end of the stream. They stay valid until the next call.
  std::span<const std::byte> peek(size_t count);

  const std::string& name() const override { return inner_.name(); }
  size_t read(std::span<std::byte> into) override;
  uint64_t skip(uint64_t count) override;
  std::optional<uint64_t> remaining() const override;
  uint64_t offset() const override { return inner_.offset() - ahead().size(); }

 private:
  std::span<const std::byte> ahead() const { return std::span(buffer_).subspan(taken_); }

  ByteReader& inner_;
  std::vector<std::byte> buffer_;
  size_t taken_ = 0;  // bytes of buffer_ that read() or skip() has consumed
};

}  // namespace voyager
