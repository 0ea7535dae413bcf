#pragma once
// What `voyager render` was asked.
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tools/frame_files.h"
#include "tools/image_size.h"
#include "tools/lod_options.h"
#include "tools/renderer.h"

namespace voyager::tools {

struct RenderArguments {
  std::string scene, cameras;  // cameras: "" for a view from outside
  int64_t camera = 0;
  bool all = false, stereo = false;
  ImageSize size;
  std::optional<bool> wait_resident;
  LodChoice lod;
  RenderChoices choices;
  OutputPaths outputs;
};

void add_render_options(CLI::App& command, RenderArguments& arguments);

}  // namespace voyager::tools
