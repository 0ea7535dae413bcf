// For programs that LeakSanitizer watches: what a Vulkan driver keeps for the process's life
// counts as leaked, and cannot be named, once the loader has unloaded it. So nothing is
// unloaded; and what the validation layer and the OpenXR loader (88 bytes an instance) leak by
// themselves is named here.
#include <dlfcn.h>

extern "C" __attribute__((visibility("default"))) int dlclose(void*) noexcept {
  return 0;
}

extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation.so\nleak:libopenxr_loader.so\n";
}

// What was suppressed is no message of the program's.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_options() {
  return "print_suppressions=0";
}
