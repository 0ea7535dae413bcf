#pragma once
// What the meta.json of a SOG scene says, in the layout of version 2 or the one before it.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "runtime/scene/import/sog/files.h"

namespace voyager::sog {

// What each code of a byte stands for.
using Table = std::array<float, 256>;

enum File { kMeansLow, kMeansHigh, kScales, kQuats, kColours, kCentroids, kLabels, kFiles };

struct Meta {
  uint64_t count = 0;
  bool antialiased = false;
  std::array<std::string, kFiles> files;  // the last two empty where there are no SH bands
  std::array<double, 3> means_least{}, means_most{};  // of sign(x) * ln(|x| + 1)
  std::array<Table, 3> scales{}, colours{};           // by axis and by channel
  Table opacities{};                                  // logits
  bool has_sh = false;
  // Version 2 says both; before it they follow from the size of the image of centroids.
  std::optional<int> sh_degree;
  std::optional<uint64_t> centroids;
  Table sh{};

  // The names that are not empty.
  std::vector<std::string> named_files() const;
};

// Throws Error(refused_input) naming the field.
Meta read_meta(const Files& files);

}  // namespace voyager::sog
