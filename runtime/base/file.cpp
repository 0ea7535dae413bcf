#include "runtime/base/file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "runtime/base/error.h"
#include "runtime/base/file_data.h"
#include "runtime/base/system_error.h"

namespace voyager {
namespace {

class SourceReader final : public ByteReader {
 public:
  explicit SourceReader(const ByteSource& source) : source_(source) {}
  const std::string& name() const override { return source_.name(); }
  size_t read(std::span<std::byte> into) override {
    const size_t count =
        static_cast<size_t>(std::min<uint64_t>(into.size(), source_.size() - offset_));
    source_.read(offset_, into.first(count));
    offset_ += count;
    return count;
  }
  uint64_t skip(uint64_t count) override {
    const uint64_t skipped = std::min(count, source_.size() - offset_);
    offset_ += skipped;
    return skipped;
  }
  std::optional<uint64_t> remaining() const override { return source_.size() - offset_; }
  uint64_t offset() const override { return offset_; }

 private:
  const ByteSource& source_;
  uint64_t offset_ = 0;
};

class StdinReader final : public ByteReader {
 public:
  const std::string& name() const override { return name_; }
  size_t read(std::span<std::byte> into) override {
    size_t count = 0;
    while (count < into.size()) {
      const ssize_t got = ::read(STDIN_FILENO, into.data() + count, into.size() - count);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw_system_error(name_, "read");
      if (got == 0) break;
      count += static_cast<size_t>(got);
    }
    offset_ += count;
    return count;
  }
  std::optional<uint64_t> remaining() const override { return std::nullopt; }
  uint64_t offset() const override { return offset_; }

 private:
  std::string name_ = "standard input";
  uint64_t offset_ = 0;
};

}  // namespace

bool stays_in_folder(std::string_view path) {
  if (path.empty() || path.front() == '/' || path.find('\\') != path.npos ||
      path.find('\0') != path.npos)
    return false;
  for (size_t at = 0; at <= path.size();) {
    const size_t end = std::min(path.find('/', at), path.size());
    if (path.substr(at, end - at) == "..") return false;
    at = end + 1;
  }
  return true;
}

std::unique_ptr<ByteSource> ByteSource::beside(const std::string&) const {
  throw Error(ErrorCode::refused_input,
              name() + ": found a file that names others beside it, expected a local file");
}

void check_range(const ByteSource& source, uint64_t offset, size_t count) {
  const uint64_t size = source.size();
  if (offset <= size && count <= size - offset) return;
  throw Error(ErrorCode::refused_input, source.name() + ": offset " + std::to_string(offset) +
                                            ": found " +
                                            std::to_string(size - std::min(offset, size)) +
                                            " bytes, expected " + std::to_string(count));
}

MemorySource::MemorySource(std::string name, std::span<const std::byte> bytes)
    : name_(std::move(name)), bytes_(bytes) {}

void MemorySource::read(uint64_t offset, std::span<std::byte> into) const {
  check_range(*this, offset, into.size());
  if (!into.empty()) std::memcpy(into.data(), bytes_.data() + offset, into.size());
}

uint64_t ByteReader::skip(uint64_t count) {
  std::array<std::byte, 16384> unused;
  uint64_t skipped = 0;
  while (skipped < count) {
    const size_t wanted = static_cast<size_t>(std::min<uint64_t>(unused.size(), count - skipped));
    const size_t got = read(std::span(unused).first(wanted));
    skipped += got;
    if (got < wanted) break;
  }
  return skipped;
}

std::unique_ptr<ByteReader> read_source(const ByteSource& source) {
  return std::make_unique<SourceReader>(source);
}

std::unique_ptr<ByteReader> read_stdin() {
  auto reader = std::make_unique<StdinReader>();
  require_data(STDIN_FILENO, reader->name());
  return reader;
}

}  // namespace voyager
