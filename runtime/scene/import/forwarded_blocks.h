#pragma once
// A base of readers that pass on what another has, changed in one way.
#include <memory>
#include <utility>

#include "runtime/scene/import/block_reader.h"

namespace voyager {

class ForwardedBlocks : public BlockReader {
 public:
  explicit ForwardedBlocks(std::unique_ptr<BlockReader> reader) : reader_(std::move(reader)) {}
  const std::string& name() const override { return reader_->name(); }
  uint64_t count() const override { return reader_->count(); }
  int sh_degree() const override { return reader_->sh_degree(); }
  NativeScale native() const override { return reader_->native(); }
  std::array<double, 3> origin() const override { return reader_->origin(); }
  RawBlock next(size_t most) override { return reader_->next(most); }
  GaussianCloud decode(const RawBlock& block) const override { return reader_->decode(block); }

 private:
  std::unique_ptr<BlockReader> reader_;
};

}  // namespace voyager
