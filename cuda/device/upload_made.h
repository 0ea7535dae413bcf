#pragma once
// Arrays that are made on their way to the device.
#include <algorithm>
#include <vector>

#include "cuda/device/buffer.h"

namespace voyager::cuda {

inline constexpr size_t kUploadBlock = size_t{1} << 18;  // elements at a time through a host buffer

// into[i] by make(i), block by block.
template <class T, class Make>
void upload_made(const Buffer<T>& into, const Make& make) {
  const size_t count = into.size();
  std::vector<T> staging(std::min(count, kUploadBlock));
  for (size_t first = 0; first < count; first += kUploadBlock) {
    const size_t n = std::min(kUploadBlock, count - first);
    for (size_t i = 0; i < n; ++i) staging[i] = make(first + i);
    check(cudaMemcpy(into.data() + first, staging.data(), n * sizeof(T), cudaMemcpyHostToDevice),
          "upload of a scene");
  }
  check(cudaStreamSynchronize(nullptr), "upload of a scene");
}
template <class T, class Make>
Buffer<T> upload_made(size_t count, const Make& make) {
  Buffer<T> buffer(count);
  upload_made(buffer, make);
  return buffer;
}

}  // namespace voyager::cuda
