#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "runtime/base/error.h"
#include "runtime/scene/export/writer.h"

namespace voyager {
namespace {

class FileSink final : public PlacedSink {
 public:
  explicit FileSink(AtomicFile& file) : file_(file) {}
  void write(std::span<const std::byte> bytes) override { file_.write(bytes); }
  void write_at(uint64_t offset, std::span<const std::byte> bytes) override {
    file_.write_at(offset, bytes);
  }

 private:
  AtomicFile& file_;
};

class StdoutSink final : public ByteSink {
 public:
  void write(std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t put = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
      if (put < 0 && errno == EINTR) continue;
      if (put < 0)
        throw Error(ErrorCode::io, std::string("standard output: write: ") + std::strerror(errno));
      bytes = bytes.subspan(static_cast<size_t>(put));
    }
  }
};

}  // namespace

std::unique_ptr<PlacedSink> sink_to(AtomicFile& file) {
  return std::make_unique<FileSink>(file);
}
std::unique_ptr<ByteSink> sink_to_stdout() {
  return std::make_unique<StdoutSink>();
}

}  // namespace voyager
