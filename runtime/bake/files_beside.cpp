#include "runtime/bake/files_beside.h"

#include <array>
#include <memory>
#include <span>
#include <string_view>

#include "runtime/base/file.h"
#include "runtime/base/open_source.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager {
namespace {

using Names = std::set<std::string>;

// A file that notes which others are opened from it.
class NotedSource final : public ByteSource {
 public:
  NotedSource(std::unique_ptr<ByteSource> source, std::shared_ptr<Names> names)
      : source_(std::move(source)), names_(std::move(names)) {}

  const std::string& name() const override { return source_->name(); }
  uint64_t size() const override { return source_->size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    source_->read(offset, into);
  }
  std::unique_ptr<ByteSource> open_beside(const std::string& path) const override {
    std::unique_ptr<ByteSource> other = source_->open_beside(path);
    names_->insert(other->name());
    return std::make_unique<NotedSource>(std::move(other), names_);
  }

 private:
  std::unique_ptr<ByteSource> source_;
  std::shared_ptr<Names> names_;
};

// JSON and glTF alone refer to files; the header of another format may take long to read.
bool may_refer_to_files(const ByteSource& source) {
  std::array<std::byte, 1> first{};
  if (source.size() < first.size()) return false;
  source.read(0, first);
  constexpr std::string_view kFirst = "{g \t\r\n";
  return kFirst.find(static_cast<char>(first[0])) != std::string_view::npos;
}

}  // namespace

std::set<std::string> files_beside(const std::string& input) {
  const auto names = std::make_shared<Names>();
  const auto source = std::make_shared<NotedSource>(open_source(input), names);
  if (may_refer_to_files(*source)) open_blocks(source);
  return *names;
}

}  // namespace voyager
