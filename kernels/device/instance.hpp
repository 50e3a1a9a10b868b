#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/host_cores.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/device/runtime.hpp"

namespace drogue::device {

/// Instance of an execution space: on a GPU a stream of its own, for OpenMP a pool of at most `most_threads`
/// threads, fewer on shared cores (`cores_are_shared`), elsewhere the default instance. An instance
/// constructed from an execution space shares it.
template <class ExecutionSpace>
class Instance {
 public:
  /// The default instance of a host, or a stream of its own. Throws std::runtime_error for an error of HIP.
  explicit Instance(int /*most_threads*/) : _space(make_space()) {}

  /// Shares `space`. Does not throw.
  explicit Instance(const ExecutionSpace& space) : _space(space) {}

  /// Execution space of all work of this instance. Does not throw.
  [[nodiscard]] const ExecutionSpace& space() const { return _space; }

 private:
  static ExecutionSpace make_space() {
    if constexpr (is_host<ExecutionSpace>)
      return ExecutionSpace();
    else
      return Kokkos::Experimental::partition_space(ExecutionSpace(), 1)[0];
  }

  ExecutionSpace _space;
};

#if defined(KOKKOS_ENABLE_OPENMP)
template <>
class Instance<Kokkos::OpenMP> {
 public:
  /// A pool of at most `most_threads` threads, of fewer on shared cores. Does not throw.
  explicit Instance(int most_threads) {
    const int threads = useful_threads_on(cores_are_shared(), most_threads);
    if (threads < _space.concurrency()) _space = Kokkos::OpenMP(threads);
  }

  /// Shares `space`. Does not throw.
  explicit Instance(const Kokkos::OpenMP& space) : _space(space) {}

  /// Execution space of all work of this instance. Does not throw.
  [[nodiscard]] const Kokkos::OpenMP& space() const { return _space; }

 private:
  Kokkos::OpenMP _space;
};
#endif

#if defined(KOKKOS_ENABLE_CUDA)
template <>
class Instance<Kokkos::Cuda> {
 public:
  /// Creates a non-blocking stream, which the destructor fences and destroys. Throws std::runtime_error for a
  /// CUDA error.
  explicit Instance(int /*most_threads*/) : _stream(create_stream()), _space(_stream), _owns_stream(true) {}

  /// Shares the stream of `space`, which must outlive the instance. Does not throw.
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

  /// Execution space of all work of this instance. Does not throw.
  [[nodiscard]] const Kokkos::Cuda& space() const { return _space; }

  /// CUDA stream of the instance. Does not throw.
  [[nodiscard]] cudaStream_t stream() const { return _stream; }

 private:
  static cudaStream_t create_stream() {
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
