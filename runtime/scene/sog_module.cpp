#include "runtime/scene/sog_module.h"

#include <string>

#include "runtime/base/error.h"
#include "runtime/base/module.h"

namespace voyager {
namespace {

// `name` is what a message calls the scene that wants it.
const SogModule& sog_module(const std::string& name) {
  try {
    return *static_cast<const SogModule*>(open_module(
        "sog", kSogModuleSymbol, module_stamp(sizeof(SogModule)), ErrorCode::unsupported));
  } catch (const Error& error) {
    throw Error(error.code(), name + ": a SOG scene: " + error.what());
  }
}

}  // namespace

std::unique_ptr<BlockReader> open_sog_blocks(std::shared_ptr<const ByteSource> source) {
  const SogModule& module = sog_module(source->name());
  return module.open(std::move(source));
}

std::unique_ptr<BlockReader> open_streamed_sog_blocks(std::shared_ptr<const ByteSource> source) {
  const SogModule& module = sog_module(source->name());
  return module.open_streamed(std::move(source));
}

void require_sog() {
  sog_module("output");
}

std::unique_ptr<GaussianWriter> write_sog(ByteSink& sink, uint64_t count, int sh_degree,
                                          const NativeScale& native) {
  return sog_module("output").write(sink, count, sh_degree, native);
}

}  // namespace voyager
