#pragma once
// A file on a disk of known latency and bandwidth, in time that a test makes pass; reads fail
// and lie as a test says.
#include <functional>
#include <map>

#include "runtime/base/error.h"
#include "tests/support/scene_files.h"

namespace voyager::test {

class SimulatedDisk final : public ByteSource {
 public:
  SimulatedDisk(Bytes bytes, double latency, double bandwidth)
      : bytes_(std::move(bytes)), latency_(latency), bandwidth_(bandwidth) {}

  const std::string& name() const override { return name_; }
  uint64_t size() const override { return bytes_.size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    busy_until_ += latency_ + static_cast<double>(into.size()) / bandwidth_;
    ++reads;
    if (fault) fault(offset, into.size());
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), into.size(), into.begin());
    if (alter) alter(offset, into);
  }

  // What it has done so far took no time.
  void start(double time) const { busy_until_ = time; }
  // Whether it could begin a read at that time.
  bool is_free(double time) const { return busy_until_ <= time; }
  // It has been idle until then.
  void idle_until(double time) const { busy_until_ = std::max(busy_until_, time); }

  std::function<void(uint64_t offset, size_t size)> fault;  // may throw
  std::function<void(uint64_t offset, std::span<std::byte>)> alter;
  mutable uint64_t reads = 0;

 private:
  const std::string name_ = "disk.voy";
  Bytes bytes_;
  double latency_, bandwidth_;
  mutable double busy_until_ = 0;
};

}  // namespace voyager::test
