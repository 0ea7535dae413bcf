// Chunks of a local file that is in no cache, read here and there by several threads, as
// streaming reads them: through the page cache and past it. VOYAGER_BENCH_FILE names the file
// (some GB on the disk to measure); without it, nothing is measured.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file.h"

namespace voyager {
namespace {

const char* file_name() {
  return std::getenv("VOYAGER_BENCH_FILE");
}

void drop_cached_pages() {
  const int fd = ::open(file_name(), O_RDONLY | O_CLOEXEC);
  ::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  ::close(fd);
}

std::unique_ptr<ByteSource> source;

void open_cold(const benchmark::State& state) {
  drop_cached_pages();
  source = open_file_source(file_name());
  source->expect(static_cast<Access>(state.range(0)));
}

// One chunk an iteration: range(1) KiB, at 4 KiB boundaries as in a .voy.
void read_chunks(benchmark::State& state) {
  const size_t bytes = static_cast<size_t>(state.range(1)) * 1024;
  std::mt19937_64 random(static_cast<unsigned>(state.thread_index()));
  std::vector<std::byte> into(bytes);
  for (auto _ : state) {
    const uint64_t blocks = (source->size() - bytes) / 4096;
    source->read(random() % blocks * 4096, into);
    benchmark::DoNotOptimize(into.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(bytes));
}

const char* const kAccess[] = {"forward", "scattered", "uncached"};

void add_benchmarks() {
  for (const int access : {0, 1, 2})
    for (const int kib : {16, 64, 256})
      for (const int threads : {1, 4})
        benchmark::RegisterBenchmark((std::string("read/") + kAccess[access]).c_str(), read_chunks)
            ->Setup(open_cold)
            ->Args({access, kib})
            ->Threads(threads)
            ->Iterations(400)
            ->UseRealTime();
}

}  // namespace
}  // namespace voyager

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (voyager::file_name() == nullptr) {
    std::fputs("source_bench: VOYAGER_BENCH_FILE: found none, expected a large file\n", stderr);
    return 1;
  }
  voyager::add_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
}
