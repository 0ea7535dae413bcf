#pragma once
// Where the inputs of a scene go: --up and --transform.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "runtime/math/affine.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager::tools {

// A matrix of three or four rows of four numbers ("1 0 0 5, 0 1 0 0, 0 0 1 0"), or terms that are
// done one after the other ("scale 2, rotate 0 1 0 90, translate 10 0 5"; degrees about an axis;
// a scale of one number or three). INRIA axes. Throws CLI::ValidationError.
Affine parse_transform(const std::string& text);

// From a scene in which `axis` is up, y, z or -y, to one in which -y is.
Affine turn_up(const std::string& axis);

struct Placement {
  std::vector<std::string> up;     // one for all inputs, or one for each
  std::vector<Affine> transforms;  // the same

  bool given() const { return !up.empty() || !transforms.empty(); }
  // For each input: first up, then the transform. Throws CLI::ValidationError for another number.
  std::vector<Affine> of(size_t inputs) const;
};

void add_placement_options(CLI::App& command, Placement& placement);

// The inputs where they belong, relative to one origin: near the middle of their places. Names are
// what messages call them.
std::vector<std::unique_ptr<BlockReader>> placed(std::vector<std::unique_ptr<BlockReader>> readers,
                                                 const std::vector<Affine>& places);

// What a bake's request says of it (bake.h); empty where nothing is moved.
std::string request_lines(const std::vector<Affine>& places);

}  // namespace voyager::tools
