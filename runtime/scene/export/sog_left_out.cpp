// In place of sog/, in a build without it.
#include "runtime/base/error.h"
#include "runtime/scene/export/writer.h"

namespace voyager {

void require_sog() {
  throw Error(ErrorCode::unsupported,
              "output: found SOG, which this build leaves out, expected a build with "
              "VOYAGER_SOG=ON, which libwebp and libzip bring");
}

std::unique_ptr<GaussianWriter> write_sog(ByteSink&, uint64_t, int, const NativeScale&) {
  require_sog();
  return nullptr;
}

}  // namespace voyager
