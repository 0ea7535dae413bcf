// Mutates a single file of an archive, or the archive's list of files.
#include <string>
#include <vector>

#include "tests/fuzz/archive.h"
#include "tests/fuzz/json_mutation.h"

namespace voyager::fuzz {
namespace {

// The first file says what is read of the others.
size_t pick(const std::vector<NamedFile>& files, Random& random) {
  return random.once_in(2) ? 0 : random.below(files.size());
}

void mutate_file(Bytes& bytes, Random& random) {
  if (!random.once_in(8) && mutate_gltf(bytes, random)) return;
  if (random.once_in(2))
    mutate_in_place(bytes);
  else
    mutate(bytes, bytes.size() + 16);
}

void mutate_list(std::vector<NamedFile>& files, Random& random) {
  NamedFile& one = files[random.below(files.size())];
  NamedFile& other = files[random.below(files.size())];
  switch (random.below(4)) {
    case 0:
      one.bytes = Bytes(other.bytes);
      return;
    case 1:
      std::swap(one.name, other.name);
      return;
    case 2:
      files.erase(files.begin() + (&one - files.data()));
      return;
    default:
      files.push_back(NamedFile(one));
  }
}

}  // namespace
}  // namespace voyager::fuzz

size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using namespace voyager::fuzz;
  Random random(seed);
  Bytes bytes(size);
  std::memcpy(bytes.data(), data, size);
  std::vector<NamedFile> files = unpacked(bytes);
  if (files.empty() || random.once_in(16)) {
    mutate(bytes, max_size);
    return hand_back(bytes, data, size, max_size);
  }
  if (random.once_in(10))
    mutate_list(files, random);
  else
    mutate_file(files[pick(files, random)].bytes, random);
  return hand_back(packed(files), data, size, max_size);
}
