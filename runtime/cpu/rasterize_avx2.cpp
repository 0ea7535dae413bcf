#define VOYAGER_ISA avx2
#include "runtime/cpu/rasterize_kernel.h"
