#pragma once

#include "kernels/fabric/elastic/make_fabric_views.hpp"
#include "kernels/fabric/stepping/step.hpp"
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
    _step = {
        slots(_fabric.triangles),
        slots(_fabric.springs),
        _fabric.rest.data(),
        _fabric.inverse_mass.data(),
        _fabric.fixed_dofs.data(),
        _fabric.load.data(),
        _fabric.moduli.lambda,
        _fabric.moduli.two_g,
        {_fabric.gravity.x, _fabric.gravity.y, _fabric.gravity.z},
        _fabric.damping,
        raw.x.data(),
        raw.v.data(),
        raw.third.data(),
        raw.fourth.data(),
        {raw.second_velocity.data(), raw.third_velocity.data()},
        {raw.monitor.steps.data(), reinterpret_cast<unsigned long long*>(raw.monitor.first_failure.data())},
        problem.dt,
        _padded};
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
    fabric::launch_packs(
        space(), label, _padded,
        fabric::RungeKuttaHalfFunctor<Kokkos::Cuda, model, last>{_fabric,
                                                                 s.x,
                                                                 s.v,
                                                                 s.third,
                                                                 s.fourth,
                                                                 {s.second_velocity, s.third_velocity},
                                                                 s.monitor,
                                                                 _problem.dt,
                                                                 {}});
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
