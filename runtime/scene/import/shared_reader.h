#pragma once
// A source's bytes as a stream that keeps it alive.
#include "runtime/base/file.h"

namespace voyager {

class SharedReader final : public ByteReader {
 public:
  explicit SharedReader(std::shared_ptr<const ByteSource> source)
      : source_(std::move(source)), reader_(read_source(*source_)) {}
  const std::string& name() const override { return reader_->name(); }
  size_t read(std::span<std::byte> into) override { return reader_->read(into); }
  uint64_t skip(uint64_t count) override { return reader_->skip(count); }
  std::optional<uint64_t> remaining() const override { return reader_->remaining(); }
  uint64_t offset() const override { return reader_->offset(); }

 private:
  std::shared_ptr<const ByteSource> source_;
  std::unique_ptr<ByteReader> reader_;
};

}  // namespace voyager
