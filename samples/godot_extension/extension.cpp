// The entry point, which addon/voyager.gdextension names.
#include "godot.h"
#include "splats_class.h"

namespace {

void initialize(void* library, GDInitializationLevel level) {
  if (level == kGDLevelScene) voyager_godot::register_splats_class(library);
}

void deinitialize(void* library, GDInitializationLevel level) {
  if (level == kGDLevelScene) voyager_godot::unregister_splats_class(library);
}

}  // namespace

// Returns 0 for a Godot older than 4.3, which then reports the extension.
extern "C" __attribute__((visibility("default"))) GDBool voyager_godot_init(
    GDGetProcAddress get, void* library, GDInitialization* initialization) {
  if (!voyager_godot::godot.load(get)) return 0;
  *initialization = {kGDLevelScene, library, initialize, deinitialize};
  return 1;
}
