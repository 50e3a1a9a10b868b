#include "perf/tridiagonal/solvers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "perf/clocks/device_time.hpp"
#include "perf/tridiagonal/solve_toeplitz.hpp"

namespace drogue::perf::tridiagonal {

template <class ExecutionSpace>
class ToeplitzSolverImpl final : public BatchSolver {
  using Functor = ToeplitzFunctor<ExecutionSpace, 0>;
  using View = typename Functor::View;
  static constexpr int members = Functor::members;

 public:
  explicit ToeplitzSolverImpl(const ToeplitzBatch& batch)
      : _count(static_cast<int>(batch.systems.size())),
        _groups((_count + members - 1) / members),
        _nodes(batch.nodes),
        _instance(_groups) {
    std::vector<double> factors(padded_size(4)), right(padded_size(_nodes));
    // The last system fills the lanes that are left over.
    for (int lane = 0; lane < _groups * members; ++lane) {
      const auto k = static_cast<std::size_t>(std::min(lane, _count - 1));
      const ToeplitzSystem& system = batch.systems[k];
      const double inverse = 1.0 / limit_pivot(system);
      const double of_system[] = {inverse, system.lower * inverse, system.upper * inverse,
                                  system.boundary_value};
      for (int m = 0; m < 4; ++m) factors[offset(lane, m, 4)] = of_system[m];
      for (int i = 0; i < _nodes; ++i)
        right[offset(lane, i, _nodes)] =
            batch.right[k * static_cast<std::size_t>(_nodes) + static_cast<std::size_t>(i)];
    }
    _factors = upload(factors);
    _right = upload(right);
    _solution = View("drogue::perf::toeplitz", right.size());
  }

  /// `solve` does not overwrite the equations.
  void reset() override {}

  void solve() override {
    enqueue();
    _instance.space().fence("drogue::perf: Toeplitz systems are solved");
  }

  double timed_solve() override {
    return device_time(_instance.space(), [this] { enqueue(); });
  }

  [[nodiscard]] std::vector<double> solution() override {
    const Kokkos::View<double*, Kokkos::HostSpace> values("drogue::perf::toeplitz on the host",
                                                          _solution.size());
    device::copy(_instance.space(), values, _solution);
    _instance.space().fence("drogue::perf: solution is on the host");
    std::vector<double> rows;
    rows.reserve(static_cast<std::size_t>(_count) * static_cast<std::size_t>(_nodes));
    for (int k = 0; k < _count; ++k)
      for (int i = 0; i < _nodes; ++i) rows.push_back(values(offset(k, i, _nodes)));
    return rows;
  }

 private:
  void enqueue() { solve_toeplitz(_instance.space(), _groups, _nodes, _factors, _right, _solution); }

  /// Length of an array of `width` numbers for each system of all groups.
  [[nodiscard]] std::size_t padded_size(int width) const {
    return static_cast<std::size_t>(_groups * members) * static_cast<std::size_t>(width);
  }
  /// Index of number i of the `width` numbers of a system.
  [[nodiscard]] static std::size_t offset(int system, int i, int width) {
    return (static_cast<std::size_t>(system / members) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(i)) *
               members +
           static_cast<std::size_t>(system % members);
  }

  /// Copies `values` to the backend. Blocking.
  [[nodiscard]] View upload(const std::vector<double>& values) const {
    const View on_device("drogue::perf::toeplitz", values.size());
    device::copy_in(_instance.space(), on_device, values.data(), values.size());
    _instance.space().fence("drogue::perf: Toeplitz systems are copied");
    return on_device;
  }

  int _count, _groups, _nodes;
  device::Instance<ExecutionSpace> _instance;
  View _factors, _right, _solution;
};

double limit_pivot(const ToeplitzSystem& system) {
  return 0.5 *
         (system.diagonal + std::sqrt(system.diagonal * system.diagonal - 4.0 * system.lower * system.upper));
}

std::unique_ptr<BatchSolver> create_toeplitz_solver(device::Backend backend, const ToeplitzBatch& batch) {
  if (batch.nodes < 33 || batch.nodes > 4096)
    throw std::invalid_argument("Toeplitz systems: the number of nodes must be from 33 to 4096");
  if (batch.systems.empty() ||
      batch.right.size() != batch.systems.size() * static_cast<std::size_t>(batch.nodes))
    throw std::invalid_argument("Toeplitz systems: each system needs one right-hand side value per node");
  return device::dispatch(backend, [&]<class ExecutionSpace>() -> std::unique_ptr<BatchSolver> {
    return std::make_unique<ToeplitzSolverImpl<ExecutionSpace>>(batch);
  });
}

}  // namespace drogue::perf::tridiagonal
