#pragma once
// Between the runtime and libvoyager_http.so.
#include <cstddef>

#include "runtime/base/error.h"
#include "runtime/base/file.h"

namespace voyager {

// What the module exports as voyager_http_module. The two sides share C++ types, so they must
// come from one build, which the stamp tells.
struct HttpModule {
  const char* stamp;
  // A source that reads ranges of what `url` (http:// or https://) names. Null on failure, with
  // *code and a terminated message of at most `size` bytes. Blocks; thread-safe.
  ByteSource* (*open)(const char* url, ErrorCode* code, char* message, size_t size);
};

inline constexpr char kHttpModuleSymbol[] = "voyager_http_module";

}  // namespace voyager
