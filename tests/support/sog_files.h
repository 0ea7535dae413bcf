#pragma once
// Small SOG scenes for tests: their files, in a zip or a folder.
#include <webp/encode.h>
#include <zip.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/sample_files.h"

namespace voyager::test {

using SogFiles = std::map<std::string, Bytes>;

inline Bytes webp(const std::vector<uint8_t>& rgba, int width, bool lossless = true) {
  WebPConfig config;
  WebPConfigInit(&config);
  config.lossless = lossless;
  config.exact = 1;  // colours where alpha is 0
  WebPPicture picture;
  WebPPictureInit(&picture);
  picture.use_argb = 1;
  picture.width = width;
  picture.height = static_cast<int>(rgba.size() / 4) / width;
  WebPPictureImportRGBA(&picture, rgba.data(), 4 * width);
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  EXPECT_TRUE(WebPEncode(&config, &picture));
  const auto view = std::as_bytes(std::span(writer.mem, writer.size));
  Bytes bytes(view.begin(), view.end());
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  return bytes;
}

inline Bytes zip(const SogFiles& files) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(source);
  zip_t* archive = zip_open_from_source(source, ZIP_TRUNCATE, &error);
  for (const auto& [name, bytes] : files)
    zip_file_add(archive, name.c_str(), zip_source_buffer(archive, bytes.data(), bytes.size(), 0),
                 0);
  EXPECT_EQ(zip_close(archive), 0);
  zip_source_open(source);
  zip_stat_t about;
  zip_source_stat(source, &about);
  Bytes whole(about.size);
  zip_source_read(source, whole.data(), whole.size());
  zip_source_close(source);
  zip_source_free(source);
  return whole;
}

inline void write_files(const std::string& folder, const SogFiles& files) {
  for (const auto& [name, bytes] : files) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
}

// Codes of `count` Gaussians that run through all bytes; rotations are sound.
inline std::vector<uint8_t> sog_pixels(size_t count, uint8_t seed, int alpha = -1) {
  std::vector<uint8_t> rgba;
  for (size_t i = 0; i < 4 * count; ++i)
    rgba.push_back(i % 4 == 3 && alpha >= 0
                       ? static_cast<uint8_t>(alpha + static_cast<int>(i / 4) % 4)
                       : static_cast<uint8_t>(i * 37 + seed));
  return rgba;
}

inline nlohmann::json sog_codebook(double least, double step) {
  nlohmann::json codes = nlohmann::json::array();
  for (int i = 0; i < 256; ++i) codes.push_back(least + step * i);
  return codes;
}

inline nlohmann::json sog_meta(size_t count, int sh_degree) {
  nlohmann::json meta = {
      {"version", 2},
      {"count", count},
      {"means",
       {{"mins", {-1, 0, 2}}, {"maxs", {1, 3, 2.5}}, {"files", {"means_l.webp", "means_u.webp"}}}},
      {"scales", {{"codebook", sog_codebook(-8, 0.03125)}, {"files", {"scales.webp"}}}},
      {"quats", {{"files", {"quats.webp"}}}},
      {"sh0", {{"codebook", sog_codebook(-2, 0.015625)}, {"files", {"sh0.webp"}}}}};
  if (sh_degree > 0)
    meta["shN"] = {{"count", 70},
                   {"bands", sh_degree},
                   {"codebook", sog_codebook(-1, 0.0078125)},
                   {"files", {"shN_centroids.webp", "shN_labels.webp"}}};
  return meta;
}

// `count` is a multiple of 4: the width of its images.
inline SogFiles sog_files(size_t count, int sh_degree) {
  SogFiles files = {{"means_l.webp", webp(sog_pixels(count, 1, 255), 4)},
                    {"means_u.webp", webp(sog_pixels(count, 90, 255), 4)},
                    {"scales.webp", webp(sog_pixels(count, 7, 255), 4)},
                    {"quats.webp", webp(sog_pixels(count, 33, 252), 4)},
                    {"sh0.webp", webp(sog_pixels(count, 200), 4)}};
  if (sh_degree > 0) {
    const int each = sh_coefficients(sh_degree) - 1;
    files["shN_centroids.webp"] =
        webp(sog_pixels(static_cast<size_t>(128 * each), 5, 255), 64 * each);
    std::vector<uint8_t> labels = sog_pixels(count, 0, 255);
    for (size_t i = 0; i < count; ++i)
      labels[4 * i] = static_cast<uint8_t>(69 - i % 70), labels[4 * i + 1] = 0;
    files["shN_labels.webp"] = webp(labels, 4);
  }
  files["meta.json"] = bytes_of(sog_meta(count, sh_degree).dump());
  return files;
}

// A streamed scene of so many files, each of `count` Gaussians (a multiple of 1000), which share
// images of one colour.
inline SogFiles one_colour_streamed_sog(size_t files, size_t count, size_t pixels) {
  SogFiles made;
  const Bytes image = webp(std::vector<uint8_t>(4 * pixels, 255), 1000);
  for (const char* name : {"means_l.webp", "means_u.webp", "scales.webp", "quats.webp", "sh0.webp"})
    made[name] = image;
  nlohmann::json children = nlohmann::json::array(), names = nlohmann::json::array();
  for (size_t i = 0; i < files; ++i) {
    names.push_back(std::to_string(i) + ".json");
    made[names.back()] = bytes_of(sog_meta(count, 0).dump());
    children.push_back({{"lods", {{"0", {{"file", i}, {"offset", 0}, {"count", count}}}}}});
  }
  const nlohmann::json lod = {{"filenames", names}, {"tree", {{"children", children}}}};
  made["lod-meta.json"] = bytes_of(lod.dump());
  return made;
}

inline GaussianCloud import_sog(const Bytes& bytes) {
  return import_gaussians(std::make_shared<MemorySource>("sample.sog", bytes));
}

}  // namespace voyager::test
