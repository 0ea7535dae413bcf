#pragma once
#include <string>

#include "runtime/base/file.h"
#include "voyager/voyager.h"

namespace voyager {

// The host's bytes. A read that returns VOY_ERROR_TIMEOUT is Error(io_transient), one that fails
// otherwise or throws Error(io).
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
