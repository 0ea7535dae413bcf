#pragma once
#include <string>

#include "runtime/base/file.h"
#include "voyager/voyager.h"

namespace voyager {

// The host's bytes. A read that fails or throws is Error(io_transient), but Error(io) where the
// result says that the bytes are gone (VOY_ERROR_FILE_NOT_FOUND, VOY_ERROR_REFUSED_INPUT).
class HostSource final : public ByteSource {
 public:
  explicit HostSource(const VoyByteSource& source)
      : source_(source), name_(source.name ? source.name : "the host's byte source") {}
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return source_.size; }
  void read(uint64_t offset, std::span<std::byte> into) const override;

 private:
  VoyByteSource source_;
  std::string name_;
};

}  // namespace voyager
