#include "perf/tridiagonal/solvers.hpp"

#include <stdexcept>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "perf/clocks/device_time.hpp"
#include "perf/tridiagonal/solve_spd.hpp"

namespace drogue::perf::tridiagonal {

template <class ExecutionSpace>
class SpdSolverImpl final : public BatchSolver {
  /// (batch, numbers of a system) in the default layout of the space: coalesced on a device.
  using View = Kokkos::View<double**, typename ExecutionSpace::memory_space>;
  using HostView = Kokkos::View<double**, typename View::array_layout, Kokkos::HostSpace>;

 public:
  explicit SpdSolverImpl(const SpdBatch& systems)
      : _batch(systems.batch),
        _instance(systems.batch),
        _initial{upload(systems.diagonal), upload(systems.off_diagonal), upload(systems.right)} {
    for (int k = 0; k < 3; ++k)
      _current[k] = View("drogue::perf::equations", _initial[k].extent(0), _initial[k].extent(1));
    SpdSolverImpl::reset();
  }

  void reset() override {
    for (int k = 0; k < 3; ++k) device::copy(_instance.space(), _current[k], _initial[k]);
    _instance.space().fence("drogue::perf: equations are restored");
  }

  void solve() override {
    enqueue();
    _instance.space().fence("drogue::perf: SPD systems are solved");
  }

  double timed_solve() override {
    return device_time(_instance.space(), [this] { enqueue(); });
  }

  [[nodiscard]] std::vector<double> solution() override {
    const HostView values("drogue::perf::solution", _current[2].extent(0), _current[2].extent(1));
    device::copy(_instance.space(), values, _current[2]);
    _instance.space().fence("drogue::perf: solution is on the host");
    std::vector<double> rows;
    rows.reserve(values.size());
    for (int k = 0; k < _batch; ++k)
      for (int i = 0; i < values.extent_int(1); ++i) rows.push_back(values(k, i));
    return rows;
  }

 private:
  void enqueue() { solve_spd(_instance.space(), _current[0], _current[1], _current[2]); }

  /// Copies `rows` (batch, any width) to the backend. Blocking.
  [[nodiscard]] View upload(const std::vector<double>& rows) const {
    const auto width = rows.size() / static_cast<std::size_t>(_batch);
    const View on_device("drogue::perf::equations", static_cast<std::size_t>(_batch), width);
    const HostView on_host("drogue::perf::equations on the host", on_device.extent(0), width);
    std::size_t next = 0;
    for (int k = 0; k < _batch; ++k)
      for (int i = 0; i < on_host.extent_int(1); ++i) on_host(k, i) = rows[next++];
    device::copy(_instance.space(), on_device, on_host);
    _instance.space().fence("drogue::perf: equations are copied");
    return on_device;
  }

  int _batch;
  device::Instance<ExecutionSpace> _instance;
  View _initial[3], _current[3];  ///< diagonal, off-diagonal, right-hand side
};

std::unique_ptr<BatchSolver> create_spd_solver(device::Backend backend, const SpdBatch& systems) {
  const auto batch = static_cast<std::size_t>(systems.batch), n = static_cast<std::size_t>(systems.unknowns);
  if (systems.batch < 1 || systems.unknowns < 1 || systems.diagonal.size() != batch * n ||
      systems.off_diagonal.size() != batch * (n - 1) || systems.right.size() != batch * n)
    throw std::invalid_argument("SPD systems: the sizes of the arrays do not match the number of unknowns");
  return device::dispatch(backend, [&]<class ExecutionSpace>() -> std::unique_ptr<BatchSolver> {
    return std::make_unique<SpdSolverImpl<ExecutionSpace>>(systems);
  });
}

}  // namespace drogue::perf::tridiagonal
