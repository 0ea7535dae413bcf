#include "runtime/stream/staged_chunk.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "runtime/base/error.h"
#include "runtime/lod/nesting.h"
#include "runtime/select/search_records.h"

namespace voyager {
namespace {

[[noreturn]] void refuse_runs(uint32_t chunk, const std::string& file) {
  throw Error(ErrorCode::damaged_chunk,
              file + ": chunk " + std::to_string(chunk) + ": found nodes of more than " +
                  std::to_string(SlotIds::kRuns) + " runs of ids, expected a run a level");
}

class Stager {
 public:
  Stager(Chunk&& chunk, uint32_t index, const Tiers& tiers, const std::string& file)
      : tiers_(tiers), file_(file) {
    out_.content = std::move(chunk);
    out_.chunk = index;
  }

  StagedChunk stage() {
    const Chunk& content = out_.content;
    set_places();
    out_.owner.reserve(content.node.size());
    uint32_t record = 0;
    for (size_t i = 0; i < content.subtrees.size(); ++i) {
      add(content.subtrees[i], content.first_subtree + static_cast<uint32_t>(i),
          content.records.data() + record);
      record += content.subtrees[i].node_count();
    }
    for (size_t i = 0; i < content.node.size(); ++i)
      if (const uint32_t children = content.record_of(i).child_count; children >= kManyChildren)
        out_.large.push_back({out_.place[i], children});
    // Nodes of a chunk come subtree by subtree, those of a slot by their ids, as a table's.
    std::sort(out_.large.begin(), out_.large.end(),
              [](const LargeFamily& a, const LargeFamily& b) { return a.parent < b.parent; });
    set_checked();
    set_links();
    return std::move(out_);
  }

 private:
  void set_places() {
    const std::vector<uint32_t>& node = out_.content.node;
    std::vector<uint32_t> sorted(node);
    std::sort(sorted.begin(), sorted.end());
    out_.place.reserve(node.size());
    for (const uint32_t id : node)
      out_.place.push_back(static_cast<uint32_t>(
          std::lower_bound(sorted.begin(), sorted.end(), id) - sorted.begin()));
    if (!make_slot_ids(sorted, out_.ids)) refuse_runs(out_.chunk, file_);
  }
  void set_checked() {
    const auto add_ends = [&](size_t subtree, uint32_t first_record) {
      const uint32_t interior = parts_[subtree].interior;
      const uint32_t child = out_.content.subtrees[subtree].root_count;
      for (const uint32_t slot : {0u, child}) {
        const auto before = static_cast<uint32_t>(std::popcount(interior & slots_before(slot)));
        out_.checked.push_back((interior >> slot & 1) != 0 ? first_record + before : 0);
      }
    };
    if (out_.records.empty()) return;
    add_ends(parts_.size() - 1, last_record_);
    if (out_.content.subtrees.front().repeats_root()) add_ends(0, 0);
  }
  void set_links() {
    const uint32_t first = out_.content.first_subtree;
    const Subtree& subtree = out_.content.subtrees.front();
    out_.links = LinkTable(parts_, child_counts_);
    out_.links.first_subtree = first;
    out_.links.next_root = subtree.root + (subtree.repeats_root() ? 1 : 0);
    out_.links.next_below = next_below_.value_or(0);
  }

  // records: of the subtree, by slot.
  void add(const Subtree& subtree, uint32_t index, const NodeRecord* records) {
    const uint32_t levels = index < tiers_.tier_begin[1] ? tiers_.first_tier_levels : kTierLevels;
    const auto record = [&](uint32_t slot) -> const NodeRecord& { return records[slot]; };
    check_repeats(subtree, records);
    const LinkTable::Part part{slot_levels(subtree), interior_slots(subtree, record),
                               family_slots(subtree, record)};
    uint32_t search_record = last_record_ = static_cast<uint32_t>(out_.records.size());
    out_.records.resize(out_.records.size() + static_cast<size_t>(std::popcount(part.interior)));
    fill_search_records(subtree, record, out_.records.data() + search_record);
    check_families(subtree, records);
    out_.owner.insert(out_.owner.end(), subtree.node_count() - subtree.first_owned_slot(),
                      static_cast<uint32_t>(parts_.size()));
    for (uint32_t slot = 0; slot < subtree.node_count(); ++slot) {
      if ((part.interior >> slot & 1) != 0) {
        if (subtree.level(slot) + 1 == levels) {
          out_.records[search_record].children = kBlocked;
          out_.checked.push_back(search_record);
          child_counts_.push_back(records[slot].child_count);
          if (in_first_tier(index) && !next_below_)
            next_below_ = out_.content.first_child[next_node_];
        }
        ++search_record;
      }
      if (!subtree.repeats(slot)) ++next_node_;
    }
    parts_.push_back(part);
    out_.roots.insert(out_.roots.end(), records, records + subtree.root_count);
  }

  void check_families(const Subtree& subtree, const NodeRecord* records) const {
    each_family(
        subtree, [&](uint32_t slot) { return records[slot].child_count; },
        [&](uint32_t parent, uint32_t first, uint32_t count) {
          for (uint32_t slot = first; slot < first + count; ++slot)
            check_inside(subtree.node(slot), records[slot], records[parent]);
        });
  }

  // The cut meets every path once only if sizes never grow downwards.
  void check_inside(uint32_t node, const NodeRecord& child, const NodeRecord& parent) const {
    if (!is_inside(child, parent)) refuse_nesting(out_.chunk, node, file_);
  }

  void check_repeats(const Subtree& subtree, const NodeRecord* records) {
    const bool first = parts_.empty();
    if (subtree.repeats_root() && !first && !is_same(records[0], root_))
      refuse_repeat(out_.chunk, subtree.root, file_);
    if (subtree.repeats_child() && !first && !is_same(records[1], child_))
      refuse_repeat(out_.chunk, subtree.first_child, file_);
    root_ = records[0];
    if (subtree.child_count != 0) child_ = records[subtree.first_child_slot()];
  }

  // Whether a subtree is in the tier that the chunk begins in.
  bool in_first_tier(uint32_t index) const {
    const auto& begin = tiers_.tier_begin;
    return *std::upper_bound(begin.begin(), begin.end(), out_.content.first_subtree) > index;
  }

  const Tiers& tiers_;
  const std::string& file_;
  StagedChunk out_;
  uint32_t next_node_ = 0;
  uint32_t last_record_ = 0;  // the first of the last subtree
  std::vector<LinkTable::Part> parts_;
  std::vector<uint32_t> child_counts_;
  std::optional<uint32_t> next_below_;
  // Of the subtree before.
  NodeRecord root_{}, child_{};
};

[[noreturn]] void refuse(uint32_t chunk, uint32_t node, const std::string& file, const char* found,
                         const char* expected) {
  throw Error(ErrorCode::damaged_chunk, file + ": chunk " + std::to_string(chunk) + ": node " +
                                            std::to_string(node) + ": found " + found +
                                            ", expected " + expected);
}

}  // namespace

void refuse_nesting(uint32_t chunk, uint32_t node, const std::string& file) {
  refuse(chunk, node, file, "a larger box or extent than its parent's", "one inside it");
}

void refuse_roots(uint32_t chunk, uint32_t node, const std::string& file) {
  refuse(chunk, node, file, "a subtree whose roots from it on hang from several nodes",
         "roots of one node");
}

void refuse_repeat(uint32_t chunk, uint32_t node, const std::string& file) {
  refuse(chunk, node, file, "two different records of it", "equal ones");
}

void refuse_gap(uint32_t chunk, const std::string& file) {
  refuse(chunk, 0, file, "more of its children, and not those of the chunk before", "both");
}

void refuse_records(const StagedChunk& staged, const std::string& file) {
  throw Error(ErrorCode::damaged_chunk,
              file + ": chunk " + std::to_string(staged.chunk) + ": found " +
                  std::to_string(staged.records.size()) +
                  " nodes with children, expected no more than the header and places allow");
}

void StagedChunk::drop_content() {
  content = {};
  records = {};
  checked = {};
  place = {};
  owner = {};
  blocks = {};
}

StagedChunk stage_chunk(Chunk&& chunk, uint32_t index, const Tiers& tiers,
                        const std::string& file) {
  return Stager(std::move(chunk), index, tiers, file).stage();
}

}  // namespace voyager
