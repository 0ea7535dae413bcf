#pragma once
// A glTF file with its buffers, as tinygltf has it.
#include <tiny_gltf.h>

#include <string>

namespace host {

// .gltf or .glb. Throws Failure(kRefusedInput), which names the file.
tinygltf::Model read_gltf(const std::string& path);

}  // namespace host
