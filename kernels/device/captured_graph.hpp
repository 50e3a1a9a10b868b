#pragma once

#include <functional>
#include <type_traits>

#include "kernels/device/instance.hpp"
#include "kernels/device/profiling_counters.hpp"

namespace drogue::device {

/// Sequence of kernels that is recorded once and launched repeatedly. On the host each launch calls it again.
template <class ExecutionSpace>
class CapturedGraph {
 public:
  using Enqueue = std::function<void(const ExecutionSpace&)>;

  /// Stores `enqueue` without calling it. `instance` must outlive the graph. Does not throw.
  CapturedGraph(const Instance<ExecutionSpace>& instance, Enqueue enqueue)
      : _instance(&instance), _enqueue(std::move(enqueue)) {}

  /// Enqueues the kernels; asynchronous where they are. Throws what `enqueue` throws.
  void launch() const { _enqueue(_instance->space()); }

  static constexpr const char* driver = "plain";

 private:
  const Instance<ExecutionSpace>* _instance;
  Enqueue _enqueue;
};

/// True while the work of `space` is captured into a CUDA graph. Throws std::runtime_error for a CUDA error.
template <class ExecutionSpace>
[[nodiscard]] bool is_capturing(const ExecutionSpace& space) {
#if defined(KOKKOS_ENABLE_CUDA)
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Cuda>) {
    cudaStreamCaptureStatus status = cudaStreamCaptureStatusNone;
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaStreamIsCapturing(space.cuda_stream(), &status));
    return status == cudaStreamCaptureStatusActive;
  }
#endif
  static_cast<void>(space);
  return false;
}

#if defined(KOKKOS_ENABLE_CUDA)
/// CUDA graph of the kernels, captured from the stream of the instance. The captured work must neither fence
/// nor allocate.
template <>
class CapturedGraph<Kokkos::Cuda> {
 public:
  using Enqueue = std::function<void(const Kokkos::Cuda&)>;

  /// Captures the kernels that `enqueue` launches, without running them. `instance` must outlive the graph.
  /// Throws std::runtime_error for a CUDA error, and what `enqueue` throws.
  CapturedGraph(const Instance<Kokkos::Cuda>& instance, const Enqueue& enqueue) : _stream(instance.stream()) {
    cudaGraph_t graph = nullptr;
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaStreamBeginCapture(_stream, cudaStreamCaptureModeThreadLocal));
    try {
      enqueue(instance.space());
    } catch (...) {
      // Leaves the stream usable for the caller that handles the error.
      if (cudaStreamEndCapture(_stream, &graph) == cudaSuccess) cudaGraphDestroy(graph);
      throw;
    }
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaStreamEndCapture(_stream, &graph));
    const cudaError_t status = cudaGraphInstantiate(&_graph, graph, 0);
    cudaGraphDestroy(graph);
    KOKKOS_IMPL_CUDA_SAFE_CALL(status);
  }
  ~CapturedGraph() { cudaGraphExecDestroy(_graph); }
  CapturedGraph(const CapturedGraph&) = delete;
  CapturedGraph& operator=(const CapturedGraph&) = delete;

  /// Enqueues one launch of the graph. Asynchronous. Throws std::runtime_error for a CUDA error.
  void launch() const {
    count_launch();
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaGraphLaunch(_graph, _stream));
  }

  static constexpr const char* driver = "graph";

 private:
  cudaStream_t _stream;
  cudaGraphExec_t _graph = nullptr;
};
#endif

}  // namespace drogue::device
