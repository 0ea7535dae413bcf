#define VOYAGER_ISA generic
#include "runtime/cpu/rasterize_kernel.h"
