#include <array>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/sog/files.h"

namespace voyager::sog {
namespace {

class FolderFiles final : public Files {
 public:
  explicit FolderFiles(std::shared_ptr<const ByteSource> meta) : meta_(std::move(meta)) {}

  const std::string& name() const override { return meta_->name(); }

  std::vector<std::byte> meta() const override {
    return read_at_most(*meta_, "meta.json", kMostMeta);
  }

  uint64_t length(std::span<const std::string> files) const override {
    uint64_t bytes = 0;
    for (const std::string& file : files) bytes += meta_->open_beside(file)->size();
    return bytes;
  }

  std::vector<std::byte> read(const std::string& file, uint64_t most) const override {
    return read_at_most(*meta_->open_beside(file), file, most);
  }

 private:
  std::vector<std::byte> read_at_most(const ByteSource& source, const std::string& file,
                                      uint64_t most) const {
    if (source.size() > most)
      refuse(name(), 0, file, std::to_string(source.size()) + " bytes",
             "at most " + std::to_string(most) + " bytes");
    return read_all(source);
  }

  std::shared_ptr<const ByteSource> meta_;
};

}  // namespace

std::unique_ptr<Files> open_folder(std::shared_ptr<const ByteSource> meta) {
  return std::make_unique<FolderFiles>(std::move(meta));
}

std::unique_ptr<Files> open_files(std::shared_ptr<const ByteSource> source) {
  std::array<std::byte, 2> first{};
  if (source->size() >= first.size()) source->read(0, first);
  if (first == std::array{std::byte{'P'}, std::byte{'K'}}) return open_zip(source);
  return open_folder(std::move(source));
}

}  // namespace voyager::sog
