#pragma once

#include <cmath>

#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/launch.hpp"
#include "kernels/flow/make_grid.hpp"
#include "perf/raw/cuda_pair.hpp"
#include "perf/raw/momentum.hpp"

namespace drogue::perf::raw {

/// `flow::MomentumFunctor` and `launch_momentum`.
class FlowPair final : public CudaPair {
 public:
  explicit FlowPair(const FlowProblem& problem)
      : _grid(flow::make_grid(problem.parameters)), _numbers(static_cast<std::size_t>(3 * _grid.component)) {
    const flow::Parameters& p = problem.parameters;
    for (State& state : _state) {
      state.out = List("drogue::perf::raw::flow_out", _numbers);
      state.old_rate = List("drogue::perf::raw::flow_rate", _numbers);
    }
    _velocity = List("drogue::perf::raw::flow_velocity", _numbers);
    to_device(_velocity, initial_velocity().data(), _numbers);

    flow::Control control{};
    control.trial.dt = control.now.last_dt = dt;
    control.trial.stop = stepping::Stop::running;
    to_device(_control, &control, 1);
    const MomentumControl raw_control{dt, dt, 0};
    to_device(_raw_control, &raw_control, 1);

    const double nu = p.viscosity / p.density, epsilon = 1e-40;
    const State &ours = of(Version::kokkos), &raw = of(Version::hand_written);
    _setup = {.grid = _grid,
              .state = _velocity,
              .stage = _velocity,
              .out = ours.out,
              .old_rate = ours.old_rate,
              .force = {},
              .eddy = {},
              .control = _control,
              .nu = nu,
              .acceleration = {0.0, 0.0, 0.0},
              .specific_volume = 1.0 / p.density,
              .epsilon = epsilon,
              .rows = flow::tile_y,
              .weights = {0.0, 1.0, true}};
    _advection = p.advection;
    const auto parts = [](int n, int size) { return (n + size - 1) / size; };
    _momentum = {
        .n = {_grid.n[0], _grid.n[1], _grid.n[2]},
        .stride = {_grid.stride[0], _grid.stride[1], _grid.stride[2]},
        .component = _grid.component,
        .first = _grid.first,
        .inverse_h = {_grid.inverse_h[0], _grid.inverse_h[1], _grid.inverse_h[2]},
        .stage = _velocity.data(),
        .out = raw.out.data(),
        .old_rate = raw.old_rate.data(),
        .force = nullptr,
        .eddy = nullptr,
        .control = _raw_control.data(),
        .nu = nu,
        .specific_volume = 1.0 / p.density,
        .acceleration = {0.0, 0.0, 0.0},
        .epsilon = epsilon,
        .planes = flow::momentum_planes(
            _advection, parts(_grid.n[0], flow::tile_x) * parts(_grid.n[1], flow::tile_y), _grid.n[2])};
  }

  void reset(Version version) override {
    Kokkos::deep_copy(space(), of(version).out, 0.0);
    Kokkos::deep_copy(space(), of(version).old_rate, 0.0);
    space().fence("drogue::perf::raw: reset");
  }

  [[nodiscard]] int block() const override { return flow::tile_x * flow::tile_y; }
  [[nodiscard]] std::int64_t cells() const override { return _grid.cells(); }

 private:
  using List = flow::List<Kokkos::Cuda>;
  static constexpr double dt = 1e-3;  // s

  /// Arrays that a version writes.
  struct State {
    List out, old_rate;
  };

  [[nodiscard]] const State& of(Version version) const { return _state[static_cast<int>(version)]; }

  /// Waves of several lengths along all axes, of both signs, m/s. Ghost cells need no periodic values here.
  [[nodiscard]] std::vector<double> initial_velocity() const {
    const auto waves = [](std::int64_t count, double number, double phase) {
      std::vector<double> values;
      for (std::int64_t i = 0; i < count; ++i)
        values.push_back(std::sin(number * static_cast<double>(i) + phase));
      return values;
    };
    const auto row = static_cast<std::size_t>(_grid.stride[1]),
               plane = static_cast<std::size_t>(_grid.stride[2]);
    std::vector<double> velocity;
    velocity.reserve(_numbers);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto phase = static_cast<double>(c);
      const std::vector<double> x = waves(_grid.stride[1], 0.1, phase),
                                y = waves(_grid.stride[2] / _grid.stride[1], 0.13, phase + 1.0),
                                z = waves(_grid.component / _grid.stride[2], 0.07, phase + 2.0);
      for (std::size_t at = 0; at < static_cast<std::size_t>(_grid.component); ++at)
        velocity.push_back(x[at % row] * y[at % plane / row] + 0.3 * z[at / plane] * x[(7 * at) % row]);
    }
    return velocity;
  }

  void enqueue(Version version) override {
    if (version == Version::hand_written)
      launch_momentum(_momentum, instance().stream());
    else
      flow::dispatch_momentum(space(), _setup, _advection);
  }

  /// Predicted velocity and rate, without a scale in common.
  [[nodiscard]] Results read(Version version) override {
    return {to_host(of(version).out, _numbers), to_host(of(version).old_rate, _numbers)};
  }

  flow::MacGrid _grid;
  std::size_t _numbers;
  List _velocity;
  State _state[2];
  flow::ControlView<Kokkos::Cuda> _control{"drogue::perf::raw::flow_control"};
  Kokkos::View<MomentumControl, Kokkos::CudaSpace> _raw_control{"drogue::perf::raw::flow_raw_control"};
  flow::MomentumSetup<Kokkos::Cuda> _setup;
  flow::Advection _advection{};
  Momentum _momentum{};
};

}  // namespace drogue::perf::raw
