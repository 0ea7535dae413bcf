#include <zip.h>

#include <algorithm>
#include <filesystem>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/sog/files.h"

namespace voyager::sog {
namespace {

struct Discard {
  void operator()(zip_t* zip) const { zip_discard(zip); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

class ZipFiles final : public Files {
 public:
  explicit ZipFiles(const ByteSource& source) : name_(source.name()), bytes_(read_all(source)) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* opened = zip_source_buffer_create(bytes_.data(), bytes_.size(), 0, &error);
    if (opened) zip_.reset(zip_open_from_source(opened, ZIP_RDONLY, &error));
    const std::string found = zip_error_strerror(&error);
    zip_error_fini(&error);
    if (zip_) return;
    zip_source_free(opened);
    refuse(name_, 0, "zip of the .sog", found, "a zip that is whole");
  }

  const std::string& name() const override { return name_; }
  std::vector<std::byte> meta() const override { return read("meta.json", kMostMeta); }
  FileBytes bytes(std::span<const std::string>) const override {
    return {{std::filesystem::path(name_).lexically_normal().string(), bytes_.size()}};
  }
  std::vector<std::byte> read(const std::string& file, uint64_t most) const override {
    zip_stat_t about;
    zip_stat_init(&about);
    if (zip_stat(zip_.get(), file.c_str(), 0, &about) != 0 || (about.valid & ZIP_STAT_SIZE) == 0)
      refuse(name_, 0, "zip of the .sog", "no file " + file, "the files that meta.json names");
    // Images are compressed already, so that a zip does not make them smaller.
    most = std::min(most, 2 * bytes_.size() + kMostMeta);
    if (about.size > most)
      refuse(name_, 0, file, std::to_string(about.size) + " bytes",
             "at most " + std::to_string(most) + " bytes");
    const std::unique_ptr<zip_file_t, Discard> entry(zip_fopen_index(zip_.get(), about.index, 0));
    std::vector<std::byte> bytes;
    if (entry) bytes.resize(static_cast<size_t>(about.size));
    // One byte more, at which the checksum is looked at.
    std::byte beyond;
    if (!entry || !fill(*entry, bytes) || zip_fread(entry.get(), &beyond, 1) != 0)
      refuse(name_, 0, file, entry ? zip_file_strerror(entry.get()) : zip_strerror(zip_.get()),
             std::to_string(about.size) + " bytes that fit their checksum");
    return bytes;
  }

 private:
  static bool fill(zip_file_t& entry, std::span<std::byte> into) {
    while (!into.empty()) {
      const zip_int64_t got = zip_fread(&entry, into.data(), into.size());
      if (got <= 0) return false;
      into = into.subspan(static_cast<size_t>(got));
    }
    return true;
  }

  std::string name_;
  std::vector<std::byte> bytes_;  // which zip_ reads
  std::unique_ptr<zip_t, Discard> zip_;
};

}  // namespace

std::unique_ptr<Files> open_zip(const std::shared_ptr<const ByteSource>& source) {
  return std::make_unique<ZipFiles>(*source);
}

}  // namespace voyager::sog
