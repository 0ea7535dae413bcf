#pragma once
// The two ways into a Scene; load_scene() tells which one a source wants.
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"

namespace voyager {

// Fills a Scene from a .voy file. A chunk that is damaged becomes an entry of
// scene.damaged and a note; a tree that breaks tree.h's invariants throws
// Error(refused_input).
void load_baked(const SceneFile& file, Workers& workers, Scene& scene);

// What a .voy file says of itself.
void set_info(const SceneFileInfo& info, Scene& scene);

// Fills a Scene from a flat file that import_gaussians() reads.
void load_flat(const std::shared_ptr<const ByteSource>& source, Workers& workers, Scene& scene);

// Notes for every counter of scene.import that is not zero, and for the SH
// bands that the input lacks.
void add_notes(Scene& scene);

}  // namespace voyager
