// Flat scenes read by one thread, from files in the page cache to a GaussianCloud:
//   read_bench FILE... [--benchmark_repetitions=5]
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "runtime/base/file.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/importer.h"

namespace voyager {
namespace {

void count(benchmark::State& state, uint64_t bytes, uint64_t gaussians) {
  const auto rate = [&](uint64_t each) {
    return benchmark::Counter(static_cast<double>(each),
                              benchmark::Counter::kIsIterationInvariantRate);
  };
  state.counters["bytes"] = rate(bytes);
  state.counters["Gaussians"] = rate(gaussians);
}

// All at once, sanitised: what a bake in memory does.
void read_whole(benchmark::State& state, const std::string& path) {
  const std::shared_ptr<const ByteSource> source = open_file_source(path);
  uint64_t gaussians = 0;
  for (auto _ : state) gaussians = import_gaussians(source).size();
  count(state, source->size(), gaussians);
}

// Block by block, words as they are: what convert does, and a bake in parts.
void read_blocks(benchmark::State& state, const std::string& path) {
  const std::shared_ptr<const ByteSource> source = open_file_source(path);
  uint64_t gaussians = 0;
  for (auto _ : state) {
    const auto reader = open_blocks(source);
    gaussians = reader->count();
    for (;;) {
      const RawBlock block = reader->next(1 << 14);
      if (block.count == 0) break;
      benchmark::DoNotOptimize(reader->decode(block).sh.data());
    }
  }
  count(state, source->size(), gaussians);
}

using Read = void(benchmark::State&, const std::string&);

void add_benchmark(const std::string& path, const char* name, Read* read) {
  benchmark::RegisterBenchmark((path + "/" + name).c_str(), [path, read](benchmark::State& state) {
    read(state, path);
  })->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace voyager

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fputs("read_bench: files: found none, expected scenes to read\n", stderr);
    return 1;
  }
  for (int i = 1; i < argc; ++i) {
    voyager::add_benchmark(argv[i], "whole", voyager::read_whole);
    voyager::add_benchmark(argv[i], "blocks", voyager::read_blocks);
  }
  benchmark::RunSpecifiedBenchmarks();
}
