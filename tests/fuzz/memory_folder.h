#pragma once
// An archive's files (archive.h), opened as files of a folder are.
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/path_beside.h"
#include "tests/fuzz/archive.h"

namespace voyager::fuzz {

class FileOfFolder final : public ByteSource {
 public:
  using Folder = std::map<std::string, std::vector<std::byte>>;

  FileOfFolder(std::shared_ptr<const Folder> folder, const std::string& name,
               std::span<const std::byte> bytes)
      : folder_(std::move(folder)), bytes_(name, bytes) {}

  const std::string& name() const override { return bytes_.name(); }
  uint64_t size() const override { return bytes_.size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    bytes_.read(offset, into);
  }
  std::unique_ptr<ByteSource> open_beside(const std::string& path) const override {
    const auto place = std::filesystem::path(name()).parent_path() / path;
    const auto file = folder_->find(place.lexically_normal().string());
    if (!stays_in_folder(path))
      throw Error(ErrorCode::refused_input, name() + ": found a reference to the file " + path +
                                                ", expected one of the archive");
    if (file == folder_->end())
      throw Error(ErrorCode::file_not_found, place.string() + ": no such file");
    return std::make_unique<FileOfFolder>(folder_, place.string(), file->second);
  }

 private:
  std::shared_ptr<const Folder> folder_;
  MemorySource bytes_;
};

// The first file of the archive. Of files with the same name the first counts.
inline std::shared_ptr<const ByteSource> open_archive(std::span<const std::byte> input) {
  std::vector<NamedFile> files = unpacked(input);
  if (files.empty()) return std::make_shared<MemorySource>("empty", input);
  const std::string first = files.front().name;
  const auto folder = std::make_shared<FileOfFolder::Folder>();
  for (NamedFile& file : files) folder->try_emplace(file.name, std::move(file.bytes));
  return std::make_shared<FileOfFolder>(folder, first, folder->at(first));
}

}  // namespace voyager::fuzz
