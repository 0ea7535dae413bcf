#pragma once
// What a view does without by the choices that it was made with, and because its frames came
// without depth limits (docs/omissions.md).
#include "runtime/frame/backend.h"

namespace voyager {

struct ViewChoices {
  PipelineDesc desc;
  bool limits = false;       // some frame had them
  uint32_t limit_bytes = 0;  // a pixel, that the pipeline keeps of a host's limits
};

// What these choices leave out, in addition to omissions_of(shape).
std::vector<Omission> omissions_of(const ViewChoices& choices, const ViewShape& shape);

}  // namespace voyager
