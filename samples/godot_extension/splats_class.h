#pragma once
// VoyagerSplats in Godot's class list: its methods, and how their values go to and fro.

namespace voyager_godot {

// `library` is the pointer that Godot passed to the extension.
void register_splats_class(void* library);
void unregister_splats_class(void* library);

}  // namespace voyager_godot
