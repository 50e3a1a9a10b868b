#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::device {

/// An execution-space instance of its own: on CUDA a stream, elsewhere the default instance.
template <class ExecutionSpace>
class Instance {
 public:
  [[nodiscard]] const ExecutionSpace& space() const { return _space; }

 private:
  ExecutionSpace _space;
};

#if defined(KOKKOS_ENABLE_CUDA)
template <>
class Instance<Kokkos::Cuda> {
 public:
  Instance() : _stream(create()), _space(_stream) {}
  ~Instance() {
    _space.fence("drogue::device::instance: last use");
    _space = Kokkos::Cuda();
    cudaStreamDestroy(_stream);
  }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  [[nodiscard]] const Kokkos::Cuda& space() const { return _space; }
  [[nodiscard]] cudaStream_t stream() const { return _stream; }

 private:
  static cudaStream_t create() {
    cudaStream_t stream = nullptr;
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
    return stream;
  }

  cudaStream_t _stream;
  Kokkos::Cuda _space;
};
#endif

}  // namespace drogue::device
