#pragma once
#include <string>

#include "runtime/base/file.h"
#include "runtime/scene/import/importer.h"

namespace voyager::test {

inline GaussianCloud import_file(const std::string& path) {
  return import_gaussians(open_file_source(path));
}

}  // namespace voyager::test
