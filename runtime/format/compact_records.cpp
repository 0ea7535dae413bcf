#include "runtime/format/compact_records.h"

#include "runtime/format/byte_planes.h"
#include "runtime/format/plane_order.h"
#include "runtime/format/record_planes.h"

namespace voyager {
namespace {

const NodeRecord* parent_of(const Families& families, uint32_t record, const Chunk& chunk) {
  const uint32_t parent = families.parent[record];
  return parent == kNoNode ? nullptr : &chunk.records[parent];
}

NodeRecord hull_of_children(const Families& families, uint32_t record, const Chunk& chunk) {
  const Families::Run& run = families.children[record];
  return hull_of_boxes(&chunk.records[run.first], run.count);
}

std::byte* put_boxes_and_extents(std::byte* at, const Chunk& chunk, const ChunkCounts& counts,
                                 const Families& families, ExtentRule rule,
                                 const EndGroup& end_group) {
  const PlaneOrder boxes = box_order(families);
  std::vector<BoxWords> words;
  for (size_t i = 0; i < boxes.item.size(); ++i) {
    const uint32_t record = boxes.item[i];
    const NodeRecord& r = chunk.records[record];
    words.push_back(i < boxes.plain ? box_words(r)
                                    : box_words(r, hull_of_children(families, record, chunk)));
  }
  BytePlanes plain(at, boxes.plain);
  for (size_t word = 0; word < 6; ++word) {
    plain.put(4, [&](size_t i) { return words[i].word[word]; });
    if (word == 3) end_group(plain.position());
  }
  BytePlanes told(plain.position(), words.size() - boxes.plain);
  for (size_t word = 0; word < 6; ++word)
    told.put(4, [&](size_t i) { return words[boxes.plain + i].word[word]; });
  const PlaneOrder extents = extent_order(families, counts);
  const auto word_of = [&](size_t i) {
    const uint32_t record = extents.item[i];
    return extent_word(rule, chunk.records[record], parent_of(families, record, chunk));
  };
  BytePlanes plain_extents(told.position(), extents.plain);
  plain_extents.put(4, word_of);
  BytePlanes told_extents(plain_extents.position(), words.size() - extents.plain);
  told_extents.put(4, [&](size_t i) { return word_of(extents.plain + i); });
  return told_extents.position();
}

void take_boxes(std::byte*& at, const Families& families, Chunk& chunk) {
  const PlaneOrder boxes = box_order(families);
  std::vector<BoxWords> words(chunk.records.size());
  const auto take = [&](size_t first, size_t end) {
    BytePlanes planes(at, end - first);
    for (size_t word = 0; word < 6; ++word)
      planes.take(4, [&](size_t i, uint32_t v) { words[first + i].word[word] = v; });
    at = planes.position();
  };
  take(0, boxes.plain);
  take(boxes.plain, words.size());
  for (size_t i = 0; i < words.size(); ++i) {
    const uint32_t record = boxes.item[i];
    if (i < boxes.plain)
      set_box(words[i], chunk.records[record]);
    else
      set_box(words[i], hull_of_children(families, record, chunk), chunk.records[record]);
  }
}

void take_extents(std::byte*& at, const ChunkCounts& counts, const Families& families,
                  ExtentRule rule, Chunk& chunk) {
  const PlaneOrder extents = extent_order(families, counts);
  const auto take = [&](size_t first, size_t end) {
    BytePlanes planes(at, end - first);
    planes.take(4, [&](size_t i, uint32_t v) {
      const uint32_t record = extents.item[first + i];
      NodeRecord& r = chunk.records[record];
      r.extent = extent_of_word(v, rule, r, parent_of(families, record, chunk));
    });
    at = planes.position();
  };
  take(0, extents.plain);
  take(extents.plain, chunk.records.size());
}

// In the order of their planes.
std::span<uint8_t SubtreeCounts::*const> count_planes(uint32_t version) {
  static constexpr uint8_t SubtreeCounts::*kLevels[] = {
      &SubtreeCounts::roots, &SubtreeCounts::children, &SubtreeCounts::grandchildren};
  return std::span(kLevels).last(subtree_count_bytes(version));
}

}  // namespace

std::byte* put_records(std::byte* at, const Chunk& chunk, const ChunkCounts& counts,
                       const Families& families, const ChunkContext& context,
                       const EndGroup& end_group) {
  BytePlanes table(at, chunk.subtrees.size());
  for (const auto level : count_planes(context.version))
    table.put(1, [&](size_t i) { return uint32_t{counts.of_subtree[i].*level}; });
  BytePlanes planes(table.position(), chunk.records.size());
  planes.put(4, [&](size_t i) { return counts.of_record[i]; });
  end_group(planes.position());
  return put_boxes_and_extents(planes.position(), chunk, counts, families, context.extents,
                               end_group);
}

ChunkCounts take_counts(std::byte*& at, const ChunkEntry& entry, uint32_t version) {
  ChunkCounts counts;
  counts.of_subtree.resize(entry.subtree_count, {1, 0, 0});
  BytePlanes table(at, entry.subtree_count);
  for (const auto level : count_planes(version))
    table.take(
        1, [&](size_t i, uint32_t v) { counts.of_subtree[i].*level = static_cast<uint8_t>(v); });
  BytePlanes planes(table.position(), entry.record_count);
  counts.of_record.resize(entry.record_count);
  planes.take(4, [&](size_t i, uint32_t v) { counts.of_record[i] = v; });
  at = planes.position();
  return counts;
}

void take_records(std::byte*& at, const ChunkCounts& counts, const Families& families,
                  ExtentRule rule, Chunk& chunk) {
  chunk.records.resize(counts.of_record.size());
  for (size_t i = 0; i < chunk.records.size(); ++i)
    chunk.records[i].child_count = counts.of_record[i];
  take_boxes(at, families, chunk);
  take_extents(at, counts, families, rule, chunk);
}

}  // namespace voyager
