#pragma once

#include "kernels/fabric/elastic/make_fabric_views.hpp"
#include "kernels/fabric/stepping/rk4.hpp"
#include "perf/raw/cuda_pair.hpp"
#include "perf/raw/fabric_step.hpp"

namespace drogue::perf::raw {

/// Both `fabric::RungeKuttaHalfFunctor` of a step, and `launch_fabric_step`.
class FabricPair final : public CudaPair {
 public:
  explicit FabricPair(const FabricProblem& problem)
      : _problem(problem),
        _vertices(problem.x.size()),
        _padded(fabric::padded_vertices(static_cast<int>(problem.x.size()))),
        _fabric(fabric::make_fabric_views(space(), problem.parameters)) {
    for (State& state : _state) {
      for (Points* points :
           {&state.x, &state.v, &state.third, &state.fourth, &state.second_velocity, &state.third_velocity})
        *points = fabric::make_points<Kokkos::Cuda>("drogue::perf::raw::fabric", _vertices);
      state.monitor =
          stepping::make_monitor<Kokkos::Cuda>(Monitor::StatusView("drogue::perf::raw::fabric_status"));
    }
    const auto slots = [](const auto& of) {
      return SlicedEll{of.first.data(), of.neighbour.data(), of.value.data(),
                       static_cast<std::int64_t>(of.value.extent(0))};
    };
    const State& raw = of(Version::hand_written);
    _step = {.ring = slots(_fabric.triangles),
             .springs = slots(_fabric.springs),
             .rest = _fabric.rest.data(),
             .inverse_mass = _fabric.inverse_mass.data(),
             .fixed_axes = _fabric.fixed_dofs.data(),
             .load = _fabric.load.data(),
             .lambda = _fabric.moduli.lambda,
             .two_g = _fabric.moduli.two_g,
             .gravity = {_fabric.gravity.x, _fabric.gravity.y, _fabric.gravity.z},
             .damping = _fabric.damping,
             .x = raw.x.data(),
             .v = raw.v.data(),
             .third = raw.third.data(),
             .fourth = raw.fourth.data(),
             .velocity = {raw.second_velocity.data(), raw.third_velocity.data()},
             .count = {raw.monitor.steps.data(),
                       reinterpret_cast<unsigned long long*>(raw.monitor.first_failure.data())},
             .dt = problem.dt,
             .vertices = _padded};
  }

  void reset(Version version) override {
    const State& state = of(version);
    fabric::copy_to_points<Kokkos::Cuda>(space(), _problem.x, state.x);
    fabric::copy_to_points<Kokkos::Cuda>(space(), _problem.v, state.v);
    stepping::reset_monitor(space(), state.monitor, 0);
  }

  [[nodiscard]] int block() const override { return 128; }
  [[nodiscard]] std::int64_t cells() const override { return static_cast<std::int64_t>(_vertices); }

 private:
  using Points = fabric::PointsView<Kokkos::Cuda>;
  using Monitor = stepping::StepMonitor<Kokkos::Cuda>;
  static constexpr fabric::ConstitutiveModel model{fabric::Model::biquadratic, false};

  /// State of a version, and its work arrays.
  struct State {
    Points x, v, third, fourth, second_velocity, third_velocity;
    Monitor monitor;
  };

  [[nodiscard]] const State& of(Version version) const { return _state[static_cast<int>(version)]; }

  void enqueue(Version version) override {
    if (version == Version::hand_written) return launch_fabric_step(_step, instance().stream());
    enqueue_half<false>("drogue::perf::raw::rk4_begin");
    enqueue_half<true>("drogue::perf::raw::rk4_end");
  }

  template <bool last>
  void enqueue_half(const char* label) const {
    const State& s = of(Version::kokkos);
    fabric::launch_packs(space(), label, _padded,
                         fabric::RungeKuttaHalfFunctor<Kokkos::Cuda, model, last>{
                             .fabric = _fabric,
                             .x = s.x,
                             .v = s.v,
                             .third = s.third,
                             .fourth = s.fourth,
                             .velocity = {s.second_velocity, s.third_velocity},
                             .monitor = s.monitor,
                             .dt = _problem.dt,
                             .vertex_force = {}});
  }

  /// Positions, velocities and the number of steps.
  [[nodiscard]] Results read(Version version) override {
    const State& state = of(version);
    const auto count = static_cast<std::size_t>(3 * _padded);
    return {to_host(state.x, count),
            to_host(state.v, count),
            {static_cast<double>(stepping::completed_steps(space(), state.monitor, 0))}};
  }

  FabricProblem _problem;
  std::size_t _vertices;
  int _padded;
  fabric::FabricViews<Kokkos::Cuda> _fabric;
  State _state[2];
  FabricStep _step{};
};

}  // namespace drogue::perf::raw
