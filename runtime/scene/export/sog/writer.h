#pragma once
#include "runtime/scene/export/writer.h"

namespace voyager::sog_export {

// write_sog()
std::unique_ptr<GaussianWriter> write(ByteSink& sink, uint64_t count, int sh_degree,
                                      const NativeScale& native);

}  // namespace voyager::sog_export
