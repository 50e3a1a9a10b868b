#include "miniapps/gas/verify/exact.hpp"

#include <algorithm>
#include <cmath>

#include "common/program/failure.hpp"
#include "common/program/progress.hpp"
#include "common/program/signals.hpp"
#include "common/run/statistics.hpp"
#include "kernels/reference/gas/exact_riemann.hpp"
#include "miniapps/gas/simulation/failure_text.hpp"
#include "miniapps/gas/simulation/fields.hpp"

namespace drogue::gas_app {

namespace {

ExactSolution riemann_solution(const GasScene& scene, double time) {
  const Riemann& r = *scene.initial.riemann;
  const auto state = [](const Primitive& w) { return reference::Primitive{w.rho, w.u, w.p}; };
  const reference::ExactRiemann exact(state(r.left), state(r.right), scene.parameters.gamma);
  return [exact, x0 = r.x0, time](double x) {
    const reference::Primitive w = exact.sample((x - x0) / time);
    return Primitive{w.rho, w.u, w.p};
  };
}

/// Initial state advected with its uniform velocity through the periodic domain.
ExactSolution advected_solution(const GasScene& scene, double time) {
  const gas::Parameters& p = scene.parameters;
  return [initial = InitialState(scene), p, time](double x) {
    const double length = p.x_max - p.x_min;
    const double origin = x - initial(x).u * time;
    return initial(origin - length * std::floor((origin - p.x_min) / length));
  };
}

/// Linear interpolation between the cell centres of the reference.
ExactSolution interpolated_solution(const Reference& reference) {
  return [&reference](double x) {
    const auto& xs = reference.x;
    const auto right = std::clamp<std::ptrdiff_t>(std::upper_bound(xs.begin(), xs.end(), x) - xs.begin(), 1,
                                                  static_cast<std::ptrdiff_t>(xs.size()) - 1);
    const auto j = static_cast<std::size_t>(right);
    const double w = (x - xs[j - 1]) / (xs[j] - xs[j - 1]);
    const auto mix = [&](const std::vector<double>& f) { return (1.0 - w) * f[j - 1] + w * f[j]; };
    return Primitive{mix(reference.rho), mix(reference.u), mix(reference.p)};
  };
}

}  // namespace

std::optional<Reference> run_reference(const GasScene& scene, device::Backend backend, bool quiet) {
  GasScene finer = scene;
  finer.parameters = *scene.verify.reference;
  const auto solver = gas::create_solver(backend, finer.parameters);
  upload_initial_state(*solver, finer);
  solver->start();
  ProgressLine progress(quiet);
  const gas::Stop stop = solver->advance(scene.end_time, -1, 0, {}, [&](const gas::Status& status) {
    progress.update(status.step, status.time, scene.end_time);
    return !interrupted();
  });
  progress.finish();
  if (stop == gas::Stop::interrupted) return std::nullopt;
  if (stop != gas::Stop::target)
    throw Failure(ExitCode::numerical_failure,
                  "the reference run of " + std::to_string(finer.parameters.cells) +
                      " cells failed: " + failure_text(*solver, finer.parameters, finer.end_time, stop));
  Reference reference;
  for_cells(*solver, finer.parameters, [&](std::int64_t cell, const Primitive& w) {
    reference.x.push_back(cell_centre(finer.parameters, cell));
    reference.rho.push_back(w.rho);
    reference.u.push_back(w.u);
    reference.p.push_back(w.p);
  });
  return reference;
}

ExactSolution exact_solution(const GasScene& scene, double time, const Reference& reference) {
  switch (scene.verify.exact.value()) {
    case Exact::riemann:
      return riemann_solution(scene, time);
    case Exact::advection:
      return advected_solution(scene, time);
    case Exact::reference:
      return interpolated_solution(reference);
  }
  return {};
}

std::map<std::string, double> error_norms(gas::Solver& solver, const gas::Parameters& parameters,
                                          const ExactSolution& exact) {
  std::array<double, 3> l1{}, l2{}, linf{};
  const double dx = (parameters.x_max - parameters.x_min) / static_cast<double>(parameters.cells);
  for_cells(solver, parameters, [&](std::int64_t cell, const Primitive& w) {
    const Primitive e = exact(cell_centre(parameters, cell));
    const std::array<double, 3> error = {std::abs(w.rho - e.rho), std::abs(w.u - e.u), std::abs(w.p - e.p)};
    for (std::size_t k = 0; k < 3; ++k) {
      l1[k] += error[k] * dx;
      l2[k] += error[k] * error[k] * dx;
      linf[k] = run::maximum_or_nan(linf[k], error[k]);
    }
  });
  std::map<std::string, double> norms;
  const std::array<const char*, 3> names = {"density", "velocity", "pressure"};
  for (std::size_t k = 0; k < 3; ++k) {
    norms[std::string("l1_") + names[k]] = l1[k];
    norms[std::string("l2_") + names[k]] = std::sqrt(l2[k]);
    norms[std::string("linf_") + names[k]] = linf[k];
  }
  return norms;
}

}  // namespace drogue::gas_app
