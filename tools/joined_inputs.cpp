#include "tools/joined_inputs.h"

#include <string>
#include <utility>

#include "runtime/scene/append.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/import/merged_blocks.h"
#include "tools/console.h"

namespace voyager::tools {
namespace {

using Readers = std::vector<std::unique_ptr<BlockReader>>;

void require_all_alike(const Readers& readers) {
  const BlockReader& first = *readers.front();
  for (const auto& reader : readers)
    require_alike(first.origin(), first.native(), reader->origin(), reader->native(),
                  reader->name());
}

// What a reader holds goes when its turn is over.
BlockPart part_of(std::unique_ptr<BlockReader> reader) {
  BlockPart part{reader->count(), reader->sh_degree(), reader->native(), {}};
  part.open = [kept = std::shared_ptr<BlockReader>(std::move(reader))]() mutable {
    return std::exchange(kept, nullptr);
  };
  return part;
}

}  // namespace

std::unique_ptr<BlockReader> open_joined(
    const std::vector<std::shared_ptr<const ByteSource>>& sources, const Placement& placement) {
  Readers readers;
  for (const auto& source : sources) readers.push_back(open_blocks(source));
  if (placement.given()) {
    const std::vector<Affine> places = placement.of(readers.size());
    readers = placed(std::move(readers), places);
  }
  require_all_alike(readers);
  if (readers.size() == 1) return std::move(readers.front());
  const std::string name = readers.front()->name();
  const std::array<double, 3> origin = readers.front()->origin();
  std::vector<BlockPart> parts;
  for (auto& reader : readers) parts.push_back(part_of(std::move(reader)));
  return merge_blocks(name, std::move(parts), origin);
}

void note_left_out(const ByteSource& source) {
  for (const std::string& what : left_out_of(source)) warn(source.name() + ": left out: " + what);
}

}  // namespace voyager::tools
