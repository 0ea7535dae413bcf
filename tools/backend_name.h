#pragma once
#include "voyager/voyager.h"

namespace voyager::tools {

// As --backend takes it.
inline const char* backend_name(VoyBackend backend) {
  switch (backend) {
    case VOY_BACKEND_CPU:
      return "cpu";
    case VOY_BACKEND_CUDA:
      return "cuda";
    case VOY_BACKEND_REFERENCE:
      return "reference";
    default:
      return "auto";
  }
}

}  // namespace voyager::tools
