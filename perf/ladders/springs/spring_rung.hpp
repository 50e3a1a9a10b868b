#pragma once

#include <cmath>
#include <limits>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/springs/problem.hpp"
#include "perf/ladders/springs/tension.hpp"

namespace drogue::perf::ladder {

/// Stiffnesses of a triangle as `stored_tensions` takes them, N/m^3. Does not throw.
inline void stiffnesses(const SpringProblem& problem, const VertexTriangle& t, double inverse_area,
                        double* k) {
  const double all = t.rest[0] + t.rest[1] + t.rest[2];
  double cotangent[3];
  for (int e = 0; e < 3; ++e) cotangent[e] = 0.25 * inverse_area * (all - 2.0 * t.rest[e]);
  const auto stiffness = [&](int e, int f, double mu) {
    return inverse_area / 16.0 * (problem.two_lambda_mu * cotangent[e] * cotangent[f] + mu);
  };
  k[0] = stiffness(1, 1, problem.mu), k[1] = stiffness(2, 2, problem.mu);
  k[2] = stiffness(1, 2, -problem.mu), k[3] = stiffness(2, 0, -problem.mu);
  k[4] = stiffness(0, 1, -problem.mu);
}

/// 1 / area of a triangle at rest, 1/m^2, by Heron's formula. Does not throw.
inline double inverse_area(const VertexTriangle& t) {
  const double* r = t.rest;
  const double all = r[0] + r[1] + r[2];
  return 4.0 / std::sqrt(all * all - 2.0 * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]));
}

/// A stage of the classical Runge-Kutta method at a vertex: slopes at the state of the stage, sums of slopes,
/// state of the next stage or, in stage 3, of the next step. `Sheet` holds the state and the triangles.
template <class Sheet>
struct SpringStageFunctor {
  Sheet sheet;
  int stage;
  double dt, gravity;

  KOKKOS_FUNCTION void operator()(int i) const {
    const int from = stage % 2;
    Point v = sheet.v(from, i), a{0.0, 0.0, 0.0};
    if (!sheet.is_pinned(i)) {
      a = (1.0 / sheet.mass(i)) * sheet.force(from, i);
      a.z += gravity;
    }
    const double weight = stage == 1 || stage == 2 ? 2.0 : 1.0;
    Point sum_v = weight * v, sum_a = weight * a;
    if (stage > 0) sum_v = sum_v + sheet.sum_v(i), sum_a = sum_a + sheet.sum_a(i);
    if (stage == 3) {
      const Point x_new = sheet.start_x(i) + (dt / 6.0) * sum_v,
                  v_new = sheet.start_v(i) + (dt / 6.0) * sum_a;
      sheet.set(0, i, x_new, v_new);
      sheet.set_start(i, x_new, v_new);
      return;
    }
    const double part = stage == 2 ? dt : 0.5 * dt;
    sheet.set_sums(i, sum_v, sum_a);
    sheet.set(1 - from, i, sheet.start_x(i) + part * v, sheet.start_v(i) + part * a);
  }
};

/// Base of the rungs with kernels of their own. `Sheet` is made from a numbering of the problem and offers
/// the functions above, `upload(space, state)` and `positions(space)`.
template <class ExecutionSpace, class Sheet>
class SpringRung final : public RungRun {
 public:
  SpringRung(const SpringProblem& problem, Numbering SpringProblem::*numbering)
      : _problem(problem),
        _numbering(problem.*numbering),
        _instance(std::numeric_limits<int>::max()),
        _sheet(problem, _numbering, _instance.space()) {}

  void reset() override {
    _sheet.upload(_instance.space(), _numbering.start);
    _instance.space().fence("drogue::perf::ladder: state is set");
  }

  void run() override {
    for (long step = 0; step < _problem.steps; ++step)
      for (int stage = 0; stage < 4; ++stage)
        device::launch_each(
            _instance.space(), "drogue::perf::ladder::spring_stage", static_cast<int>(_numbering.vertices()),
            SpringStageFunctor<Sheet>{_sheet, stage, _problem.dt, _numbering.parameters.gravity[2]});
    _instance.space().fence("drogue::perf::ladder: steps are done");
  }

  [[nodiscard]] double error() override {
    return difference(_numbering, _sheet.positions(_instance.space()));
  }

 private:
  const SpringProblem& _problem;
  const Numbering& _numbering;
  device::Instance<ExecutionSpace> _instance;
  Sheet _sheet;
};

}  // namespace drogue::perf::ladder
