#include "tools/view/sparse_ply.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/scene/import/ply_header.h"

namespace voyager::view {
namespace {

class SparsePly final : public ByteSource {
 public:
  struct Rows {
    uint64_t begin, count, stride, step;  // in the file: offset, bytes; of those shown: how many
  };

  SparsePly(std::shared_ptr<const ByteSource> source, std::string header, const Rows& rows)
      : source_(std::move(source)), header_(std::move(header)), rows_(rows) {
    source_->expect(Access::scattered);
  }

  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return header_.size() + rows_.count * rows_.stride; }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    check_range(*this, offset, into.size());
    if (offset < header_.size()) {
      const size_t part = std::min<size_t>(into.size(), header_.size() - offset);
      std::memcpy(into.data(), header_.data() + offset, part);
      into = into.subspan(part);
      offset += part;
    }
    read_rows(offset - header_.size(), into);
  }

 private:
  // Rows are apart on the disk, which has more than one read to do at a time.
  void read_rows(uint64_t at, std::span<std::byte> into) const {
    constexpr size_t kThreads = 16, kLeastRows = 256;
    const size_t part =
        std::max(into.size() / kThreads + 1, kLeastRows * static_cast<size_t>(rows_.stride));
    std::vector<std::future<void>> parts;
    while (into.size() > part) {
      parts.push_back(
          std::async(std::launch::async, &SparsePly::read_part, this, at, into.first(part)));
      into = into.subspan(part);
      at += part;
    }
    read_part(at, into);
    for (std::future<void>& each : parts) each.get();
  }

  void read_part(uint64_t at, std::span<std::byte> into) const {
    while (!into.empty()) {
      const uint64_t row = at / rows_.stride, skipped = at % rows_.stride;
      const size_t part = std::min<size_t>(into.size(), rows_.stride - skipped);
      source_->read(rows_.begin + row * rows_.step * rows_.stride + skipped, into.first(part));
      into = into.subspan(part);
      at += part;
    }
  }

  std::shared_ptr<const ByteSource> source_;
  std::string header_;
  Rows rows_;
};

// With another number of vertices.
std::optional<std::string> counting(std::string header, uint64_t count) {
  const size_t line = header.find("element vertex ");
  if (line == std::string::npos) return std::nullopt;
  const size_t number = line + std::strlen("element vertex "), end = header.find('\n', number);
  return header.replace(number, end - number, std::to_string(count));
}

}  // namespace

std::shared_ptr<const ByteSource> sparse_ply(const std::shared_ptr<const ByteSource>& source,
                                             uint64_t step) {
  std::array<std::byte, 4> magic{};
  if (source->size() < magic.size()) return nullptr;
  source->read(0, magic);
  if (std::memcmp(magic.data(), "ply", 3) != 0) return nullptr;
  const auto reader = read_source(*source);
  PeekReader input(*reader);
  const ply::Header header = ply::read_header(input);
  if (header.elements.size() != 1 || header.elements[0].has_list || header.elements[0].stride == 0)
    return nullptr;
  const ply::Element& rows = header.elements[0];
  std::string text(input.offset(), '\0');
  if ((source->size() - text.size()) / rows.stride < rows.count) return nullptr;  // truncated
  source->read(0, std::as_writable_bytes(std::span(text)));
  const uint64_t count = (rows.count + step - 1) / step;
  auto shown = counting(std::move(text), count);
  if (!shown) return nullptr;
  return std::make_shared<SparsePly>(source, std::move(*shown),
                                     SparsePly::Rows{input.offset(), count, rows.stride, step});
}

}  // namespace voyager::view
