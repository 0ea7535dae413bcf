#include <zip.h>

#include <memory>
#include <new>

#include "runtime/scene/export/sog/files.h"

namespace voyager::sog_export {
namespace {

constexpr uint16_t kFirstDate = 0x21;  // 1 January 1980, in a zip's own way

struct FreeZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, FreeZip>;

void require(bool done) {
  if (!done) throw std::bad_alloc();
}

void add(zip_t& zip, const std::string& name, std::span<const std::byte> bytes) {
  Source source(zip_source_buffer(&zip, bytes.data(), bytes.size(), 0));
  require(source != nullptr);
  const zip_int64_t index = zip_file_add(&zip, name.c_str(), source.get(), ZIP_FL_ENC_UTF_8);
  require(index >= 0);
  static_cast<void>(source.release());  // the zip's now
  const auto at = static_cast<zip_uint64_t>(index);
  require(zip_set_file_compression(&zip, at, ZIP_CM_STORE, 0) == 0);
  require(zip_file_set_dostime(&zip, at, 0, kFirstDate, 0) == 0);
}

std::vector<std::byte> read(zip_source_t& source) {
  zip_stat_t about;
  zip_stat_init(&about);
  require(zip_source_stat(&source, &about) == 0 && (about.valid & ZIP_STAT_SIZE) != 0);
  std::vector<std::byte> bytes(about.size);
  require(zip_source_open(&source) == 0);
  const zip_int64_t got = zip_source_read(&source, bytes.data(), bytes.size());
  zip_source_close(&source);
  require(got == static_cast<zip_int64_t>(bytes.size()));
  return bytes;
}

}  // namespace

std::vector<std::byte> zip_of(const NamedFiles& files) {
  const Source source(zip_source_buffer_create(nullptr, 0, 0, nullptr));
  require(source != nullptr);
  std::unique_ptr<zip_t, FreeZip> zip(
      zip_open_from_source(source.get(), ZIP_CREATE | ZIP_TRUNCATE, nullptr));
  require(zip != nullptr);
  zip_source_keep(source.get());  // the zip gives one up
  for (const auto& [name, bytes] : files) add(*zip, name, bytes);
  require(zip_close(zip.get()) == 0);
  static_cast<void>(zip.release());
  return read(*source);
}

}  // namespace voyager::sog_export
