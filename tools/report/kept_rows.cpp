#include "tools/report/kept_rows.h"

#include <unistd.h>

#include <fstream>
#include <iterator>

#include "runtime/base/checksum.h"
#include "runtime/base/file.h"
#include "tools/report/kept_files.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

constexpr FolderKind kReport = {
    "a report", "give another -o, or remove the folder",
    [](std::string_view name, const std::vector<std::string>&) { return is_kept_file(name); }};

void write(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path.string());
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

}  // namespace

KeptRows::KeptRows(const std::filesystem::path& folder, const Json& provenance)
    : folder_(folder.string(), kReport,
              provenance.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", true,
              OwnedFolder::OtherKey::emptied) {}

std::filesystem::path KeptRows::path_of(const ReportCase& is, const char* ending) const {
  const std::string name = is.group + ", " + is.name();
  return std::filesystem::path(folder_.path()) /
         kept_row_name(checksum(std::as_bytes(std::span(name))), ending);
}

// The row is written last.
std::optional<KeptRow> KeptRows::find(const ReportCase& is) const {
  const Json json = Json::parse(text_of(path_of(is, kRowFigures)), nullptr, false);
  if (json.is_discarded() || json["name"] != is.name()) return std::nullopt;
  try {
    return KeptRow{row_from_json(json, is), text_of(path_of(is, kRowPicture)),
                   text_of(path_of(is, kRowDifference))};
  } catch (const Json::exception&) {  // of a build that measured less
    return std::nullopt;
  }
}

void KeptRows::keep(const KeptRow& row) {
  write(path_of(row.row.is, kRowPicture), row.picture);
  write(path_of(row.row.is, kRowDifference), row.difference);
  write(path_of(row.row.is, kRowFigures), to_json(row.row).dump() + "\n");
}

std::vector<std::string> KeptRows::remove() {
  std::vector<std::string> left = folder_.remove();
  // It was there, empty and unmarked, where a kill had come just before the end of such a call.
  ::rmdir(folder_.path().c_str());
  return left;
}

}  // namespace voyager::tools
