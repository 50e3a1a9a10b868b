#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/gas/parameters.hpp"

namespace drogue::perf::raw {

/// Version of a kernel.
enum class Version {
  kokkos,        ///< that of the suite
  hand_written,  ///< the same algorithm in CUDA
};

/// Form of the launches of a sequence of steps.
enum class Launches {
  plain,  ///< each step by itself
  graph,  ///< in captured graphs of `graph_steps`, without the host's part of a launch
};

inline constexpr long graph_steps = 16;

/// Kernel of the suite and the same algorithm written by hand, on data of their own with the same layout,
/// block size and shared memory. Functions that block throw std::runtime_error if a kernel fails.
class KernelPair {
 public:
  virtual ~KernelPair() = default;

  /// Restores the initial state of a version. Blocking.
  virtual void reset(Version version) = 0;

  /// Takes `count` steps, of a graph a multiple of `graph_steps`, and waits for them. Blocking.
  virtual void run(Version version, Launches launches, long count) = 0;

  /// Largest difference of the results of both versions after `graph_steps` steps from the initial state,
  /// relative to the largest value of its array; infinite if a value is not finite or a version leaves its
  /// state as it was. Overwrites both states. Blocking.
  [[nodiscard]] virtual double difference(Launches launches) = 0;

  /// Threads of a block.
  [[nodiscard]] virtual int block() const = 0;

  /// Cells or vertices.
  [[nodiscard]] virtual std::int64_t cells() const = 0;
};

/// Fused gas step, and the state that it starts from, kg, m, s, J per volume. A step reads one buffer and
/// writes others, so all steps do the same work.
struct GasProblem {
  gas::Parameters parameters;  ///< weights of Jiang and Shu, no limiter, three stages, alpha of the stencil
  std::array<std::vector<double>, 3> fields;
  double dt;  ///< s
};

/// Runge-Kutta steps of a sheet of St Venant-Kirchhoff triangles.
struct FabricProblem {
  fabric::Parameters parameters;
  std::vector<fabric::Vector> x, v;  ///< m, m/s
  double dt;                         ///< s
};

/// Momentum stage of a periodic flow by WENO-Z and the method of Adams and Bashforth, whose result does not
/// enter the next one.
struct FlowProblem {
  flow::Parameters parameters;
};

/// Pairs on a backend. Throw std::invalid_argument unless it is `cuda`, and std::runtime_error if memory runs
/// out.
[[nodiscard]] std::unique_ptr<KernelPair> create_pair(device::Backend backend, const GasProblem& problem);
[[nodiscard]] std::unique_ptr<KernelPair> create_pair(device::Backend backend, const FabricProblem& problem);
[[nodiscard]] std::unique_ptr<KernelPair> create_pair(device::Backend backend, const FlowProblem& problem);

}  // namespace drogue::perf::raw
