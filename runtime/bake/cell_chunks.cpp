#include "runtime/bake/cell_chunks.h"

#include "runtime/base/checksum.h"

namespace voyager {
namespace {

using TierPart = CellChunks::TierPart;

// The last bytes of the file.
struct Footer {
  uint64_t parts_at, parts_bytes, parts_sum;
};

void pack_segment(const EncodedSegment& segment, Packer& packer) {
  packer.put_all(segment.entries).put(segment.position_error).put(segment.largest_sh);
  packer.put(segment.leaves_have_extent);
  pack(segment.head, packer);
  pack(segment.tail, packer);
}

EncodedSegment unpack_segment(Unpacker& from) {
  EncodedSegment segment;
  from.take_all(segment.entries);
  segment.position_error = from.take<double>();
  segment.largest_sh = from.take<float>();
  segment.leaves_have_extent = from.take<bool>();
  segment.head = unpack_piece(from);
  segment.tail = unpack_piece(from);
  return segment;
}

std::vector<std::byte> read_checked(const ByteSource& source, uint64_t at, uint64_t bytes,
                                    uint64_t sum) {
  if (at > source.size() || bytes > source.size() - at)
    refuse_folder(source.name(), "a part beyond its end", "parts within");
  std::vector<std::byte> part(bytes);
  source.read(at, part);
  if (checksum(part) != sum)
    refuse_folder(source.name(), "another checksum at offset " + std::to_string(at),
                  std::to_string(sum));
  return part;
}

TierPart write_tier(const Segment& segment, const SegmentNodes& nodes, const BakePlan& plan,
                    const ChunkContext& context, Workers& workers, AtomicFile& file) {
  TierPart part{};
  part.chunks_at = file.position();
  const EncodedSegment encoded =
      encode_segment(segment, nodes, plan.chunk_bytes(), context, workers,
                     [&](const std::vector<std::byte>& bytes) { file.write(bytes); });
  Packer packer;
  pack_segment(encoded, packer);
  part.about_at = file.position();
  part.about_bytes = packer.bytes().size();
  part.about_sum = checksum(packer.bytes());
  file.write(packer.bytes());
  return part;
}

}  // namespace

ChunkContext encoding_context(const SplitInfo& split, Quality quality) {
  ChunkContext context;
  context.quality = quality;
  context.sh_degree = split.spool.sh_degree;
  context.leaf_count = split.spool.gaussians;
  context.extents = ExtentRule::error;  // no other is baked in parts
  return context;
}

void encode_cell(const SplitInfo& split, const BakePlan& plan, const BakedScene& top,
                 Quality quality, uint32_t cell, const WorkFolder& folder, Workers& workers) {
  CellTree tree = rebuild_cell(split, cell, folder, workers);
  align_cell(top, plan, cell, tree, workers);
  const ChunkContext context = encoding_context(split, quality);
  const auto level = [&](uint32_t index) {
    return tree.levels[std::min<size_t>(index, tree.levels.size() - 1)];
  };
  AtomicFile file(folder.file(cell_chunks_name(cell)));
  Packer parts;
  for (uint32_t tier = plan.first_cell_tier(); tier < plan.tiers().tier_count(); ++tier) {
    const uint32_t roots = plan.cell_level_of(tier);
    const SegmentNodes nodes{
        tree.baked,   kTierLevels, level(roots), level(roots + 1), &record_above(top, plan, cell),
        &tree.sources};
    parts.put(write_tier(plan.segments(tier)[cell], nodes, plan, context, workers, file));
  }
  const Footer footer{file.position(), parts.bytes().size(), checksum(parts.bytes())};
  file.write(parts.bytes());
  file.write(std::as_bytes(std::span(&footer, 1)));
  file.commit_unflushed();
  folder.drop(cell_rows_name(cell));
  folder.drop(cell_leaves_name(cell));
}

CellChunks::CellChunks(const BakePlan& plan, uint32_t cell, const WorkFolder& folder)
    : source_(open_file_source(folder.file(cell_chunks_name(cell)))) {
  Footer footer{};
  if (source_->size() < sizeof footer)
    refuse_folder(source_->name(), std::to_string(source_->size()) + " bytes",
                  "at least " + std::to_string(sizeof footer));
  source_->read(source_->size() - sizeof footer, std::as_writable_bytes(std::span(&footer, 1)));
  const std::vector<std::byte> bytes =
      read_checked(*source_, footer.parts_at, footer.parts_bytes, footer.parts_sum);
  tiers_.resize(plan.tiers().tier_count() - plan.first_cell_tier());
  Unpacker(source_->name(), bytes).take(std::span(tiers_));
}

EncodedSegment CellChunks::read_tier(uint32_t index) const {
  const TierPart& part = tiers_.at(index);
  const std::vector<std::byte> bytes =
      read_checked(*source_, part.about_at, part.about_bytes, part.about_sum);
  Unpacker from(source_->name(), bytes);
  return unpack_segment(from);
}

}  // namespace voyager
