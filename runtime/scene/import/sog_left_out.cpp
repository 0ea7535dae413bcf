// In place of sog/, in a build without it.
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/refuse.h"

namespace voyager {
namespace {

[[noreturn]] void refuse_sog(const ByteSource& source) {
  refuse(source.name(), 0, "format", "SOG, which this build leaves out",
         "a build with VOYAGER_SOG=ON, which libwebp and libzip bring");
}

}  // namespace

std::unique_ptr<BlockReader> open_sog_blocks(std::shared_ptr<const ByteSource> source) {
  refuse_sog(*source);
}

std::unique_ptr<BlockReader> open_streamed_sog_blocks(std::shared_ptr<const ByteSource> source) {
  refuse_sog(*source);
}

}  // namespace voyager
