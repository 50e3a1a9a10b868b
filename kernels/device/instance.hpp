#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::device {

/// An execution-space instance of its own: on CUDA a stream, with OpenMP a pool of at most `most_threads`
/// threads, elsewhere the default instance. Constructed from an execution space it refers to that instance.
template <class ExecutionSpace>
class Instance {
 public:
  explicit Instance(int /*most_threads*/) {}
  explicit Instance(const ExecutionSpace& space) : _space(space) {}
  [[nodiscard]] const ExecutionSpace& space() const { return _space; }

 private:
  ExecutionSpace _space;
};

#if defined(KOKKOS_ENABLE_OPENMP)
template <>
class Instance<Kokkos::OpenMP> {
 public:
  explicit Instance(int most_threads)
      : _space(most_threads < Kokkos::OpenMP().concurrency() ? Kokkos::OpenMP(most_threads)
                                                             : Kokkos::OpenMP()) {}
  explicit Instance(const Kokkos::OpenMP& space) : _space(space) {}
  [[nodiscard]] const Kokkos::OpenMP& space() const { return _space; }

 private:
  Kokkos::OpenMP _space;
};
#endif

#if defined(KOKKOS_ENABLE_CUDA)
template <>
class Instance<Kokkos::Cuda> {
 public:
  explicit Instance(int /*most_threads*/) : _stream(create()), _space(_stream), _owns_stream(true) {}
  explicit Instance(const Kokkos::Cuda& space)
      : _stream(space.cuda_stream()), _space(space), _owns_stream(false) {}
  ~Instance() {
    if (!_owns_stream) return;
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
  bool _owns_stream;
};
#endif

}  // namespace drogue::device
