#include "runtime/bake/cell_rows.h"

#include <algorithm>

#include "runtime/bake/sealed_file.h"
#include "runtime/base/checksum.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {
namespace {

// Rows of a cell that were written at once, and before them this.
struct RunHeader {
  uint64_t sum;  // of the rows' bytes
  uint32_t count, reserved;
};

// Source index, position, other words: each of four bytes.
size_t row_words(int sh_degree) {
  return 1 + 3 + other_floats(sh_degree);
}

class Distributor {
 public:
  Distributor(const SpoolInfo& spool, const SplitTree& tree, const std::array<double, 3>& origin,
              const WorkFolder& folder, Workers& workers)
      : spool_(spool),
        tree_(tree),
        origin_(origin),
        positions_(ScratchFile::open(folder.file(kPositionRows))),
        others_(ScratchFile::open(folder.file(kOtherRows))),
        workers_(workers),
        width_(row_words(spool.sh_degree)),
        folder_(folder),
        ends_(tree.cells()) {
    for (uint32_t cell = 0; cell < tree.cells(); ++cell) ScratchFile::create(file_of(cell));
  }

  // Pieces [begin, end) of the spool, in order after those before.
  void take(size_t begin, size_t end) {
    sort_in(begin, end);
    workers_.for_blocks(ends_.size(), 1, [&](size_t cell, size_t) { write_cell(cell); });
  }

 private:
  struct Piece {
    std::vector<uint32_t> cell;   // of each row
    std::vector<uint32_t> count;  // of each cell, and then where its rows start
  };

  // Opened for each run: there may be more cells than a process may have files open.
  std::string file_of(size_t cell) const {
    return folder_.file(cell_rows_name(static_cast<uint32_t>(cell)));
  }

  std::vector<uint32_t> cells_of(const SpoolPiece& piece, const std::vector<float>& positions) {
    std::vector<uint32_t> cell(piece.count);
    for (uint32_t i = 0; i < piece.count; ++i)
      cell[i] =
          tree_.node_of(local_mean(positions.data() + 3 * size_t{i}, spool_.source_origin, origin_),
                        piece.first + i);
    return cell;
  }

  // Rows by cell, those of a cell in the input's order.
  void sort_in(size_t begin, size_t end) {
    std::vector<Piece> pieces(end - begin);
    workers_.for_blocks(pieces.size(), 1, [&](size_t i, size_t) {
      const SpoolPiece& piece = spool_.pieces[begin + i];
      pieces[i].cell = cells_of(piece, read_positions(positions_, piece));
      pieces[i].count.resize(ends_.size());
      for (const uint32_t cell : pieces[i].cell) ++pieces[i].count[cell];
    });
    begin_.assign(ends_.size() + 1, 0);
    uint32_t next = 0;
    for (size_t cell = 0; cell < ends_.size(); ++cell) {
      begin_[cell] = next;
      for (Piece& piece : pieces) next += std::exchange(piece.count[cell], next);
    }
    begin_[ends_.size()] = next;
    rows_.resize(next * width_);
    workers_.for_blocks(pieces.size(), 1,
                        [&](size_t i, size_t) { put_rows(spool_.pieces[begin + i], pieces[i]); });
  }

  void put_rows(const SpoolPiece& from, Piece& piece) {
    const std::vector<float> positions = read_positions(positions_, from);
    const std::vector<float> others = read_others(others_, from, spool_);
    const size_t other = other_floats(spool_.sh_degree);
    for (uint32_t i = 0; i < from.count; ++i) {
      float* row = rows_.data() + size_t{piece.count[piece.cell[i]]++} * width_;
      const uint32_t source = from.first + i;
      std::memcpy(row, &source, sizeof source);
      std::copy_n(positions.data() + 3 * size_t{i}, 3, row + 1);
      std::copy_n(others.data() + i * other, other, row + 4);
    }
  }

  void write_cell(size_t cell) {
    const uint32_t count = begin_[cell + 1] - begin_[cell];
    if (count == 0) return;
    const auto rows = std::as_bytes(
        std::span(rows_).subspan(size_t{begin_[cell]} * width_, size_t{count} * width_));
    const RunHeader header{checksum(rows), count, 0};
    ScratchFile file = ScratchFile::open(file_of(cell));
    file.write(ends_[cell], std::as_bytes(std::span(&header, 1)));
    file.write(ends_[cell] + sizeof header, rows);
    ends_[cell] += sizeof header + rows.size();
  }

  const SpoolInfo& spool_;
  const SplitTree& tree_;
  const std::array<double, 3>& origin_;
  ScratchFile positions_, others_;
  Workers& workers_;
  size_t width_;
  const WorkFolder& folder_;
  std::vector<uint64_t> ends_;   // bytes written of each cell
  std::vector<float> rows_;      // of one take(), by cell
  std::vector<uint32_t> begin_;  // first row of each cell in rows_, and the end
};

void write_info(const WorkFolder& folder, const SpoolInfo& spool, uint32_t cell_level,
                const std::array<double, 3>& origin) {
  Packer packer;
  packer.put(spool.gaussians).put(std::array{spool.sh_degree, spool.row_degree});
  put(packer, spool.native);
  packer.put(spool.unseen_level).put_all(spool.inputs);
  packer.put(spool.source_origin).put(spool.import).put(cell_level).put(origin);
  write_sealed(folder.file(kSplitDone), packer.bytes());
}

void put_row(const float* row, size_t i, CellRows& into) {
  GaussianCloud& cloud = into.cloud;
  const size_t sh = static_cast<size_t>(cloud.coefficients()) * 3;
  std::memcpy(&into.sources[i], row, sizeof(uint32_t));
  std::copy_n(row + 1, 3, cloud.position.data() + 3 * i);
  std::copy_n(row + 4, 3, cloud.log_scale.data() + 3 * i);
  std::copy_n(row + 7, 4, cloud.rotation.data() + 4 * i);
  cloud.opacity[i] = row[11];
  std::copy_n(row + 12, sh, cloud.sh.data() + sh * i);
}

CellRows room_for(const SpoolInfo& spool, uint32_t count) {
  CellRows rows;
  GaussianCloud& cloud = rows.cloud;
  cloud.sh_degree = spool.sh_degree;
  cloud.native = spool.native;
  cloud.origin = spool.source_origin;
  cloud.position.resize(3 * size_t{count});
  cloud.log_scale.resize(3 * size_t{count});
  cloud.rotation.resize(4 * size_t{count});
  cloud.opacity.resize(count);
  cloud.sh.resize(size_t{count} * static_cast<size_t>(cloud.coefficients()) * 3);
  rows.sources.resize(count);
  return rows;
}

}  // namespace

void distribute(const SpoolInfo& spool, const SplitTree& tree, const std::array<double, 3>& origin,
                const WorkFolder& folder, uint64_t memory, Workers& workers,
                const Progress& progress) {
  Distributor distributor(spool, tree, origin, folder, workers);
  const uint64_t row = row_words(spool.sh_degree) * sizeof(float);
  constexpr uint64_t kMostRows = 1u << 23;  // runs of a cell are then a megabyte or so
  const uint64_t rows = std::min(kMostRows, memory / 2 / row);
  const auto& pieces = spool.pieces;
  for (size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    uint64_t count = 0;
    do count += pieces[end++].count;
    while (end < pieces.size() && count + pieces[end].count <= rows);
    distributor.take(begin, end);
    report(progress, "distributing", pieces[end - 1].first + uint64_t{pieces[end - 1].count},
           spool.gaussians);
  }
  write_info(folder, spool, tree.cell_level(), origin);
  for (const char* name : {kPositionRows, kOtherRows, kSpoolDone}) folder.drop(name);
}

SplitInfo read_split_info(const WorkFolder& folder, const TreeRule& rule) {
  const std::string path = folder.file(kSplitDone);
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  SplitInfo split;
  split.spool.gaussians = from.take<uint32_t>();
  const auto degrees = from.take<std::array<int32_t, 2>>();
  split.spool.sh_degree = degrees[0], split.spool.row_degree = degrees[1];
  split.spool.native = take_native(from);
  split.spool.unseen_level = from.take<int32_t>();
  from.take_all(split.spool.inputs);
  split.spool.source_origin = from.take<std::array<double, 3>>();
  split.spool.import = from.take<ImportReport>();
  split.cell_level = from.take<uint32_t>();
  split.cell_sizes = cell_sizes(split.spool.gaussians, split.cell_level, rule);
  split.origin = from.take<std::array<double, 3>>();
  return split;
}

CellRows read_cell_rows(const SplitInfo& split, uint32_t cell, const WorkFolder& folder) {
  const auto source = open_file_source(folder.file(cell_rows_name(cell)));
  CellRows rows = room_for(split.spool, split.cell_sizes.at(cell));
  const size_t width = row_words(split.spool.sh_degree);
  uint64_t at = 0;
  std::vector<float> run;
  for (size_t done = 0; done < rows.sources.size();) {
    RunHeader header;
    source->read(at, std::as_writable_bytes(std::span(&header, 1)));
    if (header.count == 0 || header.count > rows.sources.size() - done)
      refuse_folder(source->name(), std::to_string(header.count) + " rows in a run",
                    "at most " + std::to_string(rows.sources.size() - done));
    run.resize(header.count * width);
    const auto bytes = std::as_writable_bytes(std::span(run));
    source->read(at + sizeof header, bytes);
    if (checksum(bytes) != header.sum)
      refuse_folder(source->name(), "another checksum of rows at offset " + std::to_string(at),
                    std::to_string(header.sum));
    for (size_t i = 0; i < header.count; ++i) put_row(run.data() + i * width, done + i, rows);
    done += header.count;
    at += sizeof header + bytes.size();
  }
  return rows;
}

}  // namespace voyager
