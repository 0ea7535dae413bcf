#include <array>
#include <filesystem>
#include <numeric>

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

  FileBytes bytes(std::span<const std::string> files) const override {
    FileBytes bytes;
    for (const std::string& file : files) {
      const auto source = meta_->open_beside(file);
      bytes[std::filesystem::path(source->name()).lexically_normal().string()] = source->size();
    }
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

uint64_t sum_of(const FileBytes& files) {
  return std::accumulate(files.begin(), files.end(), uint64_t{0},
                         [](uint64_t sum, const auto& file) { return sum + file.second; });
}

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
