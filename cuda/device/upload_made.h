#pragma once
// Arrays that are made on their way to the device.
#include <algorithm>
#include <vector>

#include "cuda/device/buffer.h"

namespace voyager::cuda {

inline constexpr size_t kUploadBlock = size_t{1} << 18;  // elements at a time through a host buffer

// count[i] by make(i), block by block.
template <class T, class Make>
Buffer<T> upload_made(size_t count, const Make& make) {
  Buffer<T> buffer(count);
  std::vector<T> staging(std::min(count, kUploadBlock));
  for (size_t first = 0; first < count; first += kUploadBlock) {
    const size_t n = std::min(kUploadBlock, count - first);
    for (size_t i = 0; i < n; ++i) staging[i] = make(first + i);
    check(cudaMemcpy(buffer.data() + first, staging.data(), n * sizeof(T), cudaMemcpyHostToDevice),
          "upload of a scene");
  }
  check(cudaStreamSynchronize(nullptr), "upload of a scene");
  return buffer;
}

}  // namespace voyager::cuda
