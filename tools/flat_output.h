#pragma once
// What convert and export have in common: the options of flat files, and what is said of them.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "runtime/format/reader.h"
#include "runtime/scene/export/flat_file.h"

namespace voyager::tools {

// Of a scene with a tree, how much of it: a share of its leaves, or so many Gaussians.
struct Keep {
  double share = 0;    // in (0, 1], or
  uint64_t count = 0;  // at least 1
};

struct FlatArguments {
  std::optional<int> spz_version;
  bool spz_inside = false;
  std::optional<Keep> keep;
};
// "--keep P%|N", "--spz" and "--spz-version 3|4"
void add_flat_options(CLI::App& command, FlatArguments& arguments);

// Throws Error(invalid_argument) where an option was given that is not the output's.
// `writes_tilesets`: of a command that writes tileset.json, too.
FlatOptions flat_options(const FlatArguments& arguments, const std::string& output,
                         bool writes_tilesets = false);

// What --keep asks for of a baked scene, its leaves without. Says what was written.
void export_flat(const SceneFile& scene, const FlatArguments& arguments, const std::string& output);

// The same of a .hier, whose own tree is cut without a bake.
void export_kept_tree(const std::shared_ptr<const ByteSource>& source,
                      const FlatArguments& arguments, const std::string& output);

// On standard error a note for each thing that the format has no place for; on standard output what
// the file holds, and its size.
void describe_flat_file(const std::string& path, const FlatContents& contents,
                        const FlatOptions& options = {});

}  // namespace voyager::tools
