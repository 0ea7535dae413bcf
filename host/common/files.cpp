#include "files.h"

#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "failure.h"

namespace host {

namespace fs = std::filesystem;

namespace {

// What symbolic links lead to, whether it is there or not; as `voyager` does with its outputs.
fs::path written_path(const std::string& path) {
  constexpr int kMostLinks = 40;  // as the system has it
  fs::path target = path;
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code no_link;
    const fs::path next = fs::read_symlink(target, no_link);
    if (no_link) return target;
    target = target.parent_path() / next;
  }
  throw Failure(kMachine, path + ": found symbolic links in a circle, expected a file");
}

// Without links, also where nothing is there yet.
fs::path resolved(const fs::path& path) {
  std::error_code problem;
  const fs::path target = fs::absolute(written_path(path.string()), problem);
  const fs::path found = fs::weakly_canonical(target, problem);
  return problem ? target.lexically_normal() : found;
}

}  // namespace

std::string read_file(const std::string& path, uint64_t most) {
  std::error_code ignored;
  if (fs::is_other(path, ignored))
    throw Failure(kRefusedInput, path + ": found a pipe or device, expected a file");
  const auto fail = [&] { throw Failure(kRefusedInput, path + ": " + std::strerror(errno)); };
  const auto check = [&](uint64_t size) {
    if (size > most)
      throw Failure(kRefusedInput, path + ": found " + std::to_string(size) +
                                       " bytes, expected at most " + std::to_string(most));
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) fail();
  const uint64_t size = fs::file_size(path, ignored);
  if (!ignored) check(size);
  std::string bytes;
  char block[65536];
  for (size_t got = 0; (got = std::fread(block, 1, sizeof block, file.get())) > 0;)
    check(bytes.append(block, got).size());  // it may grow
  if (std::ferror(file.get()) != 0) fail();
  return bytes;
}

void require_writable(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw Failure(kMachine,
                  path + ": expected a file or a free name, not a folder, pipe or device");
  const fs::path target = written_path(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (::access(folder.c_str(), W_OK) != 0 ||
      (::access(target.c_str(), W_OK) != 0 && errno != ENOENT))
    throw Failure(kMachine, path + ": " + std::strerror(errno));
}

void require_distinct(const std::string& output, const std::vector<std::string>& others) {
  if (output.empty()) return;
  const auto same = std::find_if(others.begin(), others.end(), [&](const std::string& other) {
    std::error_code ignored;
    return !other.empty() &&
           (fs::equivalent(output, other, ignored) || resolved(output) == resolved(other));
  });
  if (same != others.end())
    throw Failure(kBadUsage, output + ": found it as an output and as " + *same +
                                 ", which is read or written too, expected different files");
}

void require_pictures(const std::string& folder, const std::vector<std::string>& others,
                      const std::function<bool(std::string_view name)>& is_picture) {
  std::error_code problem;
  for (const auto& entry : fs::directory_iterator(folder, problem)) {
    if (!is_picture(entry.path().filename().string())) continue;
    require_distinct(entry.path().string(), others);
    require_writable(entry.path().string());
  }
  for (const std::string& other : others) {
    if (other.empty()) continue;
    const fs::path path = resolved(other);
    if (path.parent_path() == resolved(folder) && is_picture(path.filename().string()))
      require_distinct(folder + "/" + path.filename().string(), {other});
  }
}

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  require_writable(path);
  const std::string target = written_path(path).string();
  const std::string temporary = target + ".part-" + std::to_string(::getpid());
  std::FILE* file = std::fopen(temporary.c_str(), "wbx");  // x: fails where there is one
  const auto fail = [&] {
    const std::string reason = std::strerror(errno);
    if (file) std::remove(temporary.c_str());
    throw Failure(kMachine, path + ": " + reason);
  };
  if (!file) fail();
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (std::fclose(file) != 0 || !written) fail();
  if (std::rename(temporary.c_str(), target.c_str()) != 0) fail();
}

void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba) {
  std::vector<uint8_t> rgb(size_t{3} * width * height);
  for (size_t i = 0; i < size_t{width} * height; ++i) std::memcpy(&rgb[3 * i], &rgba[4 * i], 3);
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw Failure(kMachine, path + ": PNG: " + image.message);
  write_file(path, std::span(bytes).first(size));
}

void write_pfm(const std::string& path, uint32_t width, uint32_t height,
               std::span<const float> values) {
  const std::string header =
      "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  const size_t row = size_t{width} * sizeof(float);
  std::vector<std::byte> bytes(header.size() + row * height);
  std::memcpy(bytes.data(), header.data(), header.size());
  for (uint32_t y = 0; y < height; ++y)
    std::memcpy(&bytes[header.size() + row * y], &values[size_t{width} * (height - 1 - y)], row);
  write_file(path, bytes);
}

}  // namespace host
