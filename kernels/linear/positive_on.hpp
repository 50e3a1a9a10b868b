#pragma once

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/linear/positive.hpp"
#include "kernels/linear/solve_positive.hpp"

namespace drogue::linear {

template <class ExecutionSpace>
class PositiveSolveOn final : public BatchSolve {
  /// (batch, numbers of a system): on a device threads that run side by side read side by side.
  using View = Kokkos::View<double**, typename ExecutionSpace::memory_space>;
  using HostView = Kokkos::View<double**, typename View::array_layout, Kokkos::HostSpace>;

 public:
  explicit PositiveSolveOn(const PositiveSystems& systems)
      : _batch(systems.batch),
        _instance(systems.batch),
        _given{upload(systems.diagonal), upload(systems.beside), upload(systems.right)} {
    for (int k = 0; k < 3; ++k)
      _now[k] = View("drogue::linear::equations", _given[k].extent(0), _given[k].extent(1));
    PositiveSolveOn::reset();
  }

  void reset() override {
    for (int k = 0; k < 3; ++k) device::copy(_instance.space(), _now[k], _given[k]);
    _instance.space().fence("drogue::linear: equations are back");
  }

  void run() override {
    solve_positive(_instance.space(), _now[0], _now[1], _now[2]);
    _instance.space().fence("drogue::linear: solved");
  }

  [[nodiscard]] std::vector<double> solution() override {
    const HostView values("drogue::linear::solution", _now[2].extent(0), _now[2].extent(1));
    device::copy(_instance.space(), values, _now[2]);
    _instance.space().fence("drogue::linear: the solution is there");
    std::vector<double> rows;
    rows.reserve(values.size());
    for (int k = 0; k < _batch; ++k)
      for (int i = 0; i < values.extent_int(1); ++i) rows.push_back(values(k, i));
    return rows;
  }

 private:
  /// `rows` (batch, any width) on the backend.
  [[nodiscard]] View upload(const std::vector<double>& rows) const {
    const auto width = rows.size() / static_cast<std::size_t>(_batch);
    const View there("drogue::linear::equations", static_cast<std::size_t>(_batch), width);
    const HostView here("drogue::linear::equations on the host", there.extent(0), width);
    std::size_t next = 0;
    for (int k = 0; k < _batch; ++k)
      for (int i = 0; i < here.extent_int(1); ++i) here(k, i) = rows[next++];
    device::copy(_instance.space(), there, here);
    _instance.space().fence("drogue::linear: equations are copied");
    return there;
  }

  int _batch;
  device::Instance<ExecutionSpace> _instance;
  View _given[3], _now[3];
};

template <class ExecutionSpace>
std::unique_ptr<BatchSolve> make_positive_solve(const PositiveSystems& systems) {
  return std::make_unique<PositiveSolveOn<ExecutionSpace>>(systems);
}

}  // namespace drogue::linear
