#pragma once
// The files of a SOG scene: in a zip (.sog), or beside a meta.json.
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/file.h"

namespace voyager::sog {

// Of files by their paths, so that one that is named twice counts once.
using FileBytes = std::map<std::string, uint64_t>;

uint64_t sum_of(const FileBytes& files);

class Files {
 public:
  virtual ~Files() = default;
  // Of the .sog or the meta.json.
  virtual const std::string& name() const = 0;
  // The text of meta.json. Refuses one of more than 256 KiB.
  virtual std::vector<std::byte> meta() const = 0;
  // Bytes that these files take where they are, compressed or not, by the path of each: of a zip,
  // the zip's.
  virtual FileBytes bytes(std::span<const std::string> files) const = 0;
  // Refuses a file that is not there, one outside the folder, and one of more than `most` bytes.
  virtual std::vector<std::byte> read(const std::string& file, uint64_t most) const = 0;
};

inline constexpr uint64_t kMostMeta = 256 * 1024;  // bytes; writers need some 16 KB

// Told by the first bytes: a zip, or else the meta.json of a folder.
std::unique_ptr<Files> open_files(std::shared_ptr<const ByteSource> source);

std::unique_ptr<Files> open_zip(const std::shared_ptr<const ByteSource>& source);
std::unique_ptr<Files> open_folder(std::shared_ptr<const ByteSource> meta);

}  // namespace voyager::sog
