#pragma once
#include <string>

#include "runtime/base/progress.h"
#include "runtime/format/reader.h"
#include "runtime/scene/export/flat_file.h"

namespace voyager {

// The leaves in the input's order, with the input's own words where the file
// is lossless (compact: restored words, scene-local). Its origin is the one of
// those positions. A cloud has one native pixel: where those of the file differ, the median leaf's.
// Holds the whole cloud. Throws Error(damaged_chunk), and
// Error(refused_input) where a leaf is missing or there twice, or a chunk does
// not go on with the tree (tree_check.h).
GaussianCloud read_leaves(const SceneFile& scene, const Progress& progress = {});

// read_leaves() as a flat file of the format that the path asks for (flat_file.h). Returns what was
// written, and an empty report: what the bake mended is not news. Throws also as write_flat_file()
// does.
FlatContents export_leaves(const SceneFile& scene, const std::string& path,
                           const FlatOptions& options = {}, const Progress& progress = {});

// The same of read_extent_cut(), of at most `most` Gaussians.
FlatContents export_extent_cut(const SceneFile& scene, uint64_t most, const std::string& path,
                               const FlatOptions& options = {}, const Progress& progress = {});

// A cloud as such a file.
FlatContents export_cloud(GaussianCloud cloud, const std::string& path, const FlatOptions& options,
                          const Progress& progress);

}  // namespace voyager
