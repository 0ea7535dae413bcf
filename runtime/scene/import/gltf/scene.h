#pragma once
// The splats of a glTF file: its primitives, and the nodes that place them.
#include "runtime/math/affine.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/gltf/nodes.h"
#include "runtime/scene/import/gltf/primitive.h"

namespace voyager::gltf {

struct Instance {
  size_t primitive;
  Affine place;  // INRIA axes
};

class Scene {
 public:
  // Throws Error(refused_input) for a required extension that is not known, a file without splats,
  // and more Gaussians than a file of its length is worth, each named.
  explicit Scene(File file);

  const std::vector<Instance>& instances() const { return instances_; }
  const Primitive& primitive(const Instance& instance) const {
    return primitives_[instance.primitive];
  }
  // As File::bytes().
  const std::map<std::string, uint64_t>& bytes() const { return bytes_; }
  // What of the SPZ inside is not read.
  const LeftOut& left_out() const { return left_out_; }
  // The instance's own Gaussians, before it is placed.
  std::unique_ptr<BlockReader> open(const Instance& instance) const;

 private:
  void read_instances(File& file);
  void add_count(const Primitive& primitive);
  void place(const MeshNode& node, const std::vector<size_t>& primitives, const File& file);

  std::string name_;
  std::map<std::string, uint64_t> bytes_;
  uint64_t total_bytes_ = 0;  // of what was opened so far
  std::vector<Primitive> primitives_;
  std::vector<Instance> instances_;
  uint64_t count_ = 0;  // of all instances, with the greatest degree
  int sh_degree_ = 0;
  LeftOut left_out_;
};

}  // namespace voyager::gltf
