#pragma once
// A glTF file with its buffers, as tinygltf has it.
#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace host {

// .gltf or .glb. `files` gets the names of all files that were read. Throws
// Failure(kRefusedInput), which names the file.
tinygltf::Model read_gltf(const std::string& path, std::vector<std::string>& files);

}  // namespace host
