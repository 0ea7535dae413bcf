#include "runtime/bake/spool.h"

#include <tbb/concurrent_queue.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/lod/build.h"
#include "runtime/scene/append.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/scale_histogram.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

constexpr size_t kMostInBlock = 1 << 16, kLeastInBlock = 256;  // Gaussians

// One block on its way.
struct Job {
  const BlockReader* reader = nullptr;
  size_t input = 0;  // of the reader
  RawBlock raw;
  std::array<double, 3> origin{0, 0, 0};
  NativeScale native;
  ImportReport import;
  std::vector<float> positions, others;
  int used_sh_degree = 0;
  ScaleHistogram scales;
  SpoolPiece piece{};
};

// The words of a row after the position, SH beyond the cloud's degree 0.
std::vector<float> rows_of(const GaussianCloud& cloud, int sh_degree) {
  const size_t width = other_floats(sh_degree), sh = static_cast<size_t>(cloud.coefficients()) * 3;
  std::vector<float> rows(cloud.size() * width);
  for (size_t i = 0; i < cloud.size(); ++i) {
    float* row = rows.data() + i * width;
    row = std::copy_n(cloud.log_scale.data() + 3 * i, 3, row);
    row = std::copy_n(cloud.rotation.data() + 4 * i, 4, row);
    *row++ = cloud.opacity[i];
    std::copy_n(cloud.sh.data() + sh * i, sh, row);
  }
  return rows;
}

class Spooler {
 public:
  // blocks: on their way at once.
  Spooler(std::vector<std::unique_ptr<BlockReader>> readers, const WorkFolder& folder,
          const NativeChoice& native, size_t in_block, size_t blocks, const Progress& progress)
      : readers_(std::move(readers)),
        in_block_(in_block),
        jobs_(blocks),
        progress_(progress),
        positions_(ScratchFile::create(folder.file(kPositionRows))),
        others_(ScratchFile::create(folder.file(kOtherRows))),
        choice_(native),
        inputs_(readers_.size()),
        announced_(announced_by(readers_)),
        pixels_(native.cameras, announced_) {
    for (Job& job : jobs_) idle_.push(&job);
    for (const auto& reader : readers_)
      info_.row_degree = std::max(info_.row_degree, reader->sh_degree());
    info_.native = readers_.front()->native();
    const std::array<double, 3> any{};
    for (const auto& reader : readers_)
      require_alike(any, info_.native, any, reader->native(), reader->name());
  }

  size_t blocks() const { return jobs_.size(); }

  // In the order of the input, one at a time; null: that was all.
  Job* next() {
    for (; current_ < readers_.size(); ++current_) {
      RawBlock raw = readers_[current_]->next(in_block_);
      if (raw.count == 0) continue;
      Job* job = nullptr;
      idle_.try_pop(job);
      job->reader = readers_[current_].get();
      job->input = current_;
      job->raw = std::move(raw);
      return job;
    }
    return nullptr;
  }

  void decode(Job& job) const {
    GaussianCloud cloud = job.reader->decode(job.raw);
    job.raw = {};
    job.origin = cloud.origin;
    job.native = cloud.native;
    sanitise(cloud);
    job.import = cloud.report;
    job.positions.assign(cloud.position.begin(), cloud.position.end());
    job.others = rows_of(cloud, info_.row_degree);
    job.used_sh_degree = used_sh_degree(cloud.sh, cloud.sh_degree);
    job.scales.add(cloud);
    job.piece.count = static_cast<uint32_t>(cloud.size());
    job.piece.position_sum = checksum(std::as_bytes(std::span(job.positions)));
    job.piece.other_sum = checksum(std::as_bytes(std::span(job.others)));
  }

  // In the order of the input, one at a time.
  void place(Job& job) {
    if (info_.import.read == 0 && job.reader == readers_.front().get())
      info_.source_origin = job.origin;
    require_alike(info_.source_origin, info_.native, job.origin, job.native, job.reader->name());
    add(info_.import, job.import);
    inputs_[job.input].scales.add(job.scales);
    info_.sh_degree = std::max(info_.sh_degree, job.used_sh_degree);
    check_count(uint64_t{info_.gaussians} + job.piece.count);
    job.piece.first = info_.gaussians;
    look(job);
    info_.gaussians += job.piece.count;
    inputs_[job.input].end = info_.gaussians;
    if (job.piece.count != 0) info_.pieces.push_back(job.piece);
    report(progress_, "reading", info_.import.read, announced_);
  }

  void write(Job& job) {
    positions_.write(uint64_t{job.piece.first} * 3 * sizeof(float),
                     std::as_bytes(std::span(job.positions)));
    others_.write(job.piece.first * other_floats(info_.row_degree) * sizeof(float),
                  std::as_bytes(std::span(job.others)));
    job = {};
    idle_.push(&job);
  }

  SpoolInfo take_info() {
    for (size_t i = 1; i < inputs_.size(); ++i)  // some may be empty
      inputs_[i].end = std::max(inputs_[i].end, inputs_[i - 1].end);
    FoundScale found = native_scale(choice_, info_.native, pixels_, inputs_);
    info_.native = found.scale;
    info_.unseen_level = found.unseen_level();
    info_.by_cameras = found.by_cameras;
    info_.inputs = std::move(found.inputs);
    return std::move(info_);
  }

 private:
  static uint64_t announced_by(const std::vector<std::unique_ptr<BlockReader>>& readers) {
    uint64_t gaussians = 0;
    for (const auto& reader : readers) gaussians += reader->count();
    return gaussians;
  }

  // Where a Gaussian is in the whole is only known in order.
  void look(const Job& job) {
    if (choice_.pixel || choice_.cameras.empty()) return;
    GaussianCloud cloud;
    cloud.origin = job.origin;
    cloud.position.assign(job.positions.begin(), job.positions.end());
    const size_t width = other_floats(info_.row_degree);
    for (size_t i = 7; i < job.others.size(); i += width) cloud.opacity.push_back(job.others[i]);
    pixels_.add(cloud, job.piece.first);
  }

  std::vector<std::unique_ptr<BlockReader>> readers_;
  size_t in_block_, current_ = 0;
  std::vector<Job> jobs_;
  tbb::concurrent_queue<Job*> idle_;
  const Progress& progress_;
  ScratchFile positions_, others_;
  SpoolInfo info_;
  const NativeChoice& choice_;
  std::vector<InputScales> inputs_;
  uint64_t announced_;
  NativePixelHistogram pixels_;
};

// What is passed on are plain pointers: oneTBB leaks any other kind where a filter throws.
void run(Spooler& spooler) {
  using Mode = tbb::filter_mode;
  const auto read = [&](tbb::flow_control& flow) {
    Job* job = spooler.next();
    if (job == nullptr) flow.stop();
    return job;
  };
  const auto decode = [&](Job* job) {
    const FloatingPointMode mode;
    spooler.decode(*job);
    return job;
  };
  const auto place = [&](Job* job) {
    spooler.place(*job);
    return job;
  };
  const auto write = [&](Job* job) { spooler.write(*job); };
  tbb::parallel_pipeline(spooler.blocks(),
                         tbb::make_filter<void, Job*>(Mode::serial_in_order, read) &
                             tbb::make_filter<Job*, Job*>(Mode::parallel, decode) &
                             tbb::make_filter<Job*, Job*>(Mode::serial_in_order, place) &
                             tbb::make_filter<Job*, void>(Mode::parallel, write));
}

void write_info(const WorkFolder& folder, const SpoolInfo& info) {
  Packer packer;
  packer.put(info.gaussians).put(std::array{info.sh_degree, info.row_degree});
  put(packer, info.native);
  packer.put(info.unseen_level).put_all(info.inputs);
  packer.put(info.source_origin).put(info.import).put_all(info.pieces);
  write_sealed(folder.file(kSpoolDone), packer.bytes());
}

std::vector<float> read_rows(const ScratchFile& file, const SpoolPiece& piece, size_t width,
                             uint64_t sum) {
  std::vector<float> rows(piece.count * width);
  const auto bytes = std::as_writable_bytes(std::span(rows));
  file.read(piece.first * width * sizeof(float), bytes);
  if (checksum(bytes) != sum)
    refuse_folder(file.path(), "another checksum of rows from " + std::to_string(piece.first),
                  std::to_string(sum));
  return rows;
}

}  // namespace

SpoolInfo spool_inputs(const OpenInputs& open, const WorkFolder& folder, uint64_t memory,
                       const NativeChoice& native, Workers& workers, const Progress& progress) {
  // A block is there as bytes, as a cloud and as rows.
  const size_t blocks = 2 * static_cast<size_t>(workers.count()) + 2;
  const size_t gaussian = 3 * sizeof(float) * (3 + other_floats(kMaxShDegree));
  const size_t in_block = std::clamp(static_cast<size_t>(memory / 2 / (blocks * gaussian)),
                                     kLeastInBlock, kMostInBlock);
  Spooler spooler(open(), folder, native, in_block, blocks, progress);
  workers.run([&] { run(spooler); });
  SpoolInfo info = spooler.take_info();
  write_info(folder, info);
  return info;
}

void put(Packer& packer, const NativeScale& native) {
  packer.put(native.source).put(native.pixel).put(native.low_pass).put(native.levels);
}

NativeScale take_native(Unpacker& from) {
  NativeScale native;
  native.source = from.take<NativeSource>();
  native.pixel = from.take<double>();
  native.low_pass = from.take<double>();
  native.levels = from.take<int>();
  return native;
}

SpoolInfo read_spool_info(const WorkFolder& folder) {
  const std::string path = folder.file(kSpoolDone);
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  SpoolInfo info;
  info.gaussians = from.take<uint32_t>();
  const auto degrees = from.take<std::array<int32_t, 2>>();
  info.sh_degree = degrees[0], info.row_degree = degrees[1];
  info.native = take_native(from);
  info.unseen_level = from.take<int32_t>();
  from.take_all(info.inputs);
  info.source_origin = from.take<std::array<double, 3>>();
  info.import = from.take<ImportReport>();
  from.take_all(info.pieces);
  return info;
}

std::vector<float> read_positions(const ScratchFile& file, const SpoolPiece& piece) {
  return read_rows(file, piece, 3, piece.position_sum);
}

std::vector<float> read_others(const ScratchFile& file, const SpoolPiece& piece,
                               const SpoolInfo& spool) {
  const size_t stored = other_floats(spool.row_degree), used = other_floats(spool.sh_degree);
  std::vector<float> rows = read_rows(file, piece, stored, piece.other_sum);
  if (used == stored) return rows;
  for (size_t i = 0; i < piece.count; ++i)
    std::copy_n(rows.data() + i * stored, used, rows.data() + i * used);
  rows.resize(piece.count * used);
  return rows;
}

}  // namespace voyager
