// Mapped memory: what kernels read of it is what the host wrote, and a piece is nobody else's
// until the device has read it. All chunks come this way, on devices that share the host's memory
// and on others.
#include <atomic>
#include <thread>
#include <vector>

#include "cuda/device/buffer.h"
#include "cuda/stream/upload_ring.h"
#include "tests/gpu/device_test.h"

namespace voyager::test {
namespace upload_ring_test {
namespace {

using cuda::Buffer;

constexpr uint32_t kWords = 4'096, kPieces = 3, kThreads = 6, kUploads = 64;  // a thread's

// One thread block, which takes its time: a piece that is written too early is read so.
__global__ void copy_slowly(const uint32_t* from, uint32_t* into, uint32_t count) {
  const long long start = clock64();
  while (clock64() - start < 100'000) {
  }
  for (uint32_t i = threadIdx.x; i < count; i += blockDim.x) into[i] = from[i];
}

class UploadRingTest : public DeviceTest {};

TEST_F(UploadRingTest, APieceIsNotWrittenBeforeTheDeviceHasReadIt) {
  const auto on = device();
  on->use();
  cuda::UploadRing ring(kWords * sizeof(uint32_t), kPieces);
  const cuda::Stream stream;
  const Buffer<uint32_t> found(size_t{kThreads} * kUploads * kWords);
  std::atomic<uint32_t> next{0};
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < kThreads; ++t)
    threads.emplace_back([&] {
      on->use();
      for (uint32_t i = next++; i < kThreads * kUploads; i = next++) {
        const cuda::UploadRing::Piece piece = ring.take();
        auto* words = reinterpret_cast<uint32_t*>(piece.host());
        for (uint32_t w = 0; w < kWords; ++w) words[w] = i * kWords + w;
        copy_slowly<<<1, 128, 0, stream.get()>>>(reinterpret_cast<const uint32_t*>(piece.device()),
                                                 found.data() + size_t{i} * kWords, kWords);
        piece.read_by(stream.get());
      }
    });
  for (std::thread& thread : threads) thread.join();
  stream.wait();
  const std::vector<uint32_t> words = cuda::download(found);
  for (size_t i = 0; i < words.size(); ++i) ASSERT_EQ(words[i], i);
}

}  // namespace
}  // namespace upload_ring_test
}  // namespace voyager::test
