#pragma once
// Between the runtime and libvoyager_sog.so.
#include <memory>

#include "runtime/scene/export/writer.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager {

// What the module exports as voyager_sog_module. The two sides share C++ types, so they must come
// from one build, which the stamp tells. Errors are those of the functions of the same purpose:
// open_sog_blocks(), open_streamed_sog_blocks(), write_sog().
struct SogModule {
  const char* stamp;
  std::unique_ptr<BlockReader> (*open)(std::shared_ptr<const ByteSource> source);
  std::unique_ptr<BlockReader> (*open_streamed)(std::shared_ptr<const ByteSource> source);
  std::unique_ptr<GaussianWriter> (*write)(ByteSink& sink, uint64_t count, int sh_degree,
                                           const NativeScale& native);
};

inline constexpr char kSogModuleSymbol[] = "voyager_sog_module";

}  // namespace voyager
