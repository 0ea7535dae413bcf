#define VOYAGER_ISA avx512
#include "runtime/cpu/rasterize_kernel.h"
