#include "runtime/scene/export/convert.h"

#include <tbb/parallel_pipeline.h>

#include <vector>

#include "runtime/base/floating_point_mode.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

constexpr size_t kInBlock = 8192;  // Gaussians: 2 MB as words of SH degree 3

// One block on its way.
struct Job {
  RawBlock raw;
  GaussianCloud cloud;
};

using TakeBatch = std::function<void(const GaussianCloud&)>;

// Decodes with all threads; `take` gets the sanitised Gaussians in the input's order.
void for_each_batch(BlockReader& reader, Workers& workers, const TakeBatch& take) {
  using Mode = tbb::filter_mode;
  std::vector<Job> jobs(2 * static_cast<size_t>(workers.count()));
  size_t next = 0;
  // At most jobs.size() are on their way, and they end in order: the next one is idle. What is
  // passed on are plain pointers: oneTBB leaks any other kind where a filter throws.
  const auto read = [&](tbb::flow_control& flow) -> Job* {
    Job& job = jobs[next++ % jobs.size()];
    job.raw = reader.next(kInBlock);
    if (job.raw.count == 0) flow.stop();
    return &job;
  };
  const auto decode = [&](Job* job) {
    const FloatingPointMode mode;
    job->cloud = reader.decode(job->raw);
    sanitise(job->cloud);
    return job;
  };
  const auto pass_on = [&](Job* job) {
    const FloatingPointMode mode;
    take(job->cloud);
    *job = Job();
  };
  workers.run([&] {
    tbb::parallel_pipeline(jobs.size(),
                           tbb::make_filter<void, Job*>(Mode::serial_in_order, read) &
                               tbb::make_filter<Job*, Job*>(Mode::parallel, decode) &
                               tbb::make_filter<Job*, void>(Mode::serial_in_order, pass_on));
  });
}

}  // namespace

FlatContents convert(const OpenBlocks& open, const std::string& path, const FlatOptions& options,
                     Workers& workers, const Progress& progress) {
  FlatContents contents;
  const std::unique_ptr<BlockReader> first = open();
  contents.sh_degree = first->sh_degree();
  contents.native = first->native();
  FlatContents announced = contents;
  announced.count = first->count();
  require_flat_file(path, announced, options);
  for_each_batch(*first, workers, [&](const GaussianCloud& batch) {
    contents.add(batch);
    report(progress, "reading", contents.report.read, first->count());
  });
  write_flat_file(path, options, contents, [&](GaussianWriter& writer) {
    const std::unique_ptr<BlockReader> second = open();
    uint64_t written = 0;
    for_each_batch(*second, workers, [&](const GaussianCloud& batch) {
      writer.append(batch);
      report(progress, "writing", written += batch.size(), contents.count);
    });
  });
  return contents;
}

}  // namespace voyager
