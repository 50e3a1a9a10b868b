#include <algorithm>
#include <cmath>

#include "common/run/statistics.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"
#include "miniapps/parachute/verify/body_drag.hpp"
#include "miniapps/parachute/verify/canopy_checks.hpp"
#include "miniapps/parachute/verify/flight.hpp"
#include "miniapps/parachute/verify/profile.hpp"
#include "miniapps/parachute/verify/row_interpolation.hpp"
#include "miniapps/parachute/verify/statistics.hpp"

namespace drogue::parachute_app {
namespace {

/// Sums of the errors of a field. A point on a side of the domain stands for half a cell.
struct ErrorSums {
  double volume = 0.0, absolute = 0.0, square = 0.0, largest = 0.0;

  void add(double error, double weight) {
    volume += weight;
    absolute += weight * std::abs(error);
    square += weight * error * error;
    largest = run::maximum_or_nan(largest, std::abs(error));
  }
};

/// Errors of values at the points of an array, less their mean where `up_to_constant`.
ErrorSums errors_of(const std::vector<double>& values, const std::vector<double>& exact,
                    const Lattice& lattice, bool up_to_constant) {
  double mean = 0.0, volume = 0.0;
  if (up_to_constant) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean += lattice.volume(i) * (values[i] - exact[i]);
      volume += lattice.volume(i);
    }
    mean /= volume;
  }
  ErrorSums sums;
  for (std::size_t i = 0; i < values.size(); ++i) sums.add(values[i] - exact[i] - mean, lattice.volume(i));
  return sums;
}

void check_curves(const Verify& wanted, const run::History& history, run::ResultDocument& result) {
  if (wanted.kinetic_energy_curves.empty() && wanted.dissipation_curves.empty()) return;
  const std::vector<double>&time = history.at("time"), &energy = history.at("kinetic_energy");
  const auto check = [&](const std::string& name, const std::vector<Curve>& curves, const auto& measure) {
    for (std::size_t i = 0; i < curves.size(); ++i) {
      double largest = 0.0;
      for (const auto& [at, value] : curves[i].points)
        largest = run::maximum_or_nan(largest, std::abs(measure(interpolate_rows(time, energy, at)) - value));
      result.add_check(name + "_" + std::to_string(i), largest / curves[i].scale(), curves[i].tolerance);
      result.state_rows(time.size());
    }
  };
  check("kinetic_energy_curve", wanted.kinetic_energy_curves,
        [](const InterpolatedRow& row) { return row.value; });
  check("dissipation_curve", wanted.dissipation_curves,
        [](const InterpolatedRow& row) { return -row.derivative; });
}

}  // namespace

/// Velocity along an axis on the whole grid on rank 0, nothing on others. Collective.
std::vector<double> Simulation::download_whole(std::size_t axis) {
  std::vector<double> own(_parts.lattice(axis).size());
  _solver->download(flow::velocity_name(axis), own);
  return _parts.whole(flow::extents(_scene.parameters, axis), std::move(own));
}

std::map<std::string, double> Simulation::error_norms() {
  const flow::Parameters& p = _scene.parameters;
  const ExactSolution& exact = _scene.verify.exact.value();
  const double time = _solver->progress().time;
  // Rank 0 adds up, so that the sums do not depend on the number of ranks.
  const auto sums_of = [&](const std::vector<double>& values, const std::string& wanted, std::size_t normal,
                           bool up_to_constant) {
    ErrorSums sums;
    _communicator.run_on_root([&] {
      const Lattice lattice = lattice_of(p, normal);
      sums = errors_of(values, evaluate(SpaceTimeFunction(wanted), lattice, time), lattice, up_to_constant);
    });
    return _communicator.broadcast(sums);
  };
  std::map<std::string, double> norms = {{"l1_velocity", 0.0}, {"l2_velocity", 0.0}, {"linf_velocity", 0.0}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const ErrorSums sums = sums_of(download_whole(axis), exact.velocity[axis], axis, false);
    norms["l1_velocity"] += sums.absolute / sums.volume;
    norms["l2_velocity"] += sums.square / sums.volume;
    double& largest = norms["linf_velocity"];
    largest = run::maximum_or_nan(largest, sums.largest);
  }
  norms["l2_velocity"] = std::sqrt(norms["l2_velocity"]);
  if (exact.pressure.empty()) return norms;
  const bool up_to_constant = std::ranges::none_of(
      p.boundary, [](const flow::Boundary& side) { return side.kind == flow::BoundaryKind::outflow; });
  const Lattice cells = _parts.lattice();
  std::vector<double> sampled(cells.size()), own(cells.size());
  sample_flow_field(flow::CellField::pressure, sampled);  // z fastest
  const auto nx = static_cast<std::size_t>(cells.n[0]), ny = static_cast<std::size_t>(cells.n[1]),
             nz = static_cast<std::size_t>(cells.n[2]);
  for (std::size_t i = 0; i < nx; ++i)
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t k = 0; k < nz; ++k) own[i + nx * (j + ny * k)] = sampled[(i * ny + j) * nz + k];
  const ErrorSums sums =
      sums_of(_parts.whole(p.cells, std::move(own)), exact.pressure, flow::at_cells, up_to_constant);
  norms["l1_pressure"] = sums.absolute / sums.volume;
  norms["l2_pressure"] = std::sqrt(sums.square / sums.volume);
  norms["linf_pressure"] = sums.largest;
  return norms;
}

void Simulation::check_totals(run::ResultDocument& result) {
  const Verify& wanted = _scene.verify;
  const flow::Totals totals = _solver->totals();
  _statistics.update(_solver->extremes());
  result.metrics.set("pressure", "divergence_rms", totals.divergence_rms);
  if (wanted.divergence) result.add_check("divergence", totals.divergence_rms, *wanted.divergence);
  if (wanted.momentum) {
    const double mass = fluid_mass(_scene.parameters);
    result.add_check("momentum", _statistics.momentum_change(totals, mass), *wanted.momentum);
  }
  if (wanted.energy_growth)
    result.add_check("energy_growth", _statistics.energy_growth(), *wanted.energy_growth);
  if (wanted.speed_growth)
    result.add_check("speed_growth", std::max(_statistics.speed_growth(), 0.0), *wanted.speed_growth);
  if (!wanted.dissipation_peak) return;
  const DissipationPeak& peak = *wanted.dissipation_peak;
  result.add_deviation("dissipation_peak", _statistics.peak_dissipation(), peak.value, peak.tolerance);
  if (peak.time)
    result.add_distance("dissipation_peak_time", _statistics.peak_time(), *peak.time, *peak.time_tolerance);
}

void Simulation::check_profiles(run::ResultDocument& result) {
  for (std::size_t i = 0; i < _scene.verify.profiles.size(); ++i) {
    const Profile& profile = _scene.verify.profiles[i];
    const std::string name = "profile_" + std::to_string(i);
    const std::vector<double> all = download_whole(static_cast<std::size_t>(profile.component));
    if (all.empty()) continue;  // the checks of rank 0 count
    const SampledLine line = sample_line(all, _scene.parameters, profile);
    if (!profile.points.empty()) {
      double largest = 0.0;
      for (const auto& [where, value] : profile.points) {
        largest = run::maximum_or_nan(largest, std::abs(line(where) - value));
      }
      result.add_check(name, largest, profile.tolerance);
    }
    const auto check = [&](const std::string& which, const std::optional<Extremum>& wanted, double sign) {
      if (!wanted) return;
      const auto [where, value] = line.maximum(sign);
      result.add_distance(name + which, value, wanted->value, wanted->tolerance);
      if (wanted->at) result.add_distance(name + which + "_at", where, *wanted->at, *wanted->at_tolerance);
    };
    check("_minimum", profile.minimum, -1.0);
    check("_maximum", profile.maximum, 1.0);
  }
}

ExitCode Simulation::verify(const run::RunDirectory* directory, run::ResultDocument& result) {
  const Verify& wanted = _scene.verify;
  if (wanted.exact) {
    result.errors = error_norms();
    for (const auto& [name, tolerance] : wanted.tolerances)
      result.add_check(name, result.errors.at(name), tolerance);
  }
  if (wanted.divergence || wanted.momentum || wanted.needs_extremes()) check_totals(result);
  if (_coupled != nullptr) _peaks.update(*_coupled);
  _communicator.run_on_root([&] {
    const run::History rows = rows_of(_scene, directory);
    check_canopies(wanted, _peaks, rows, result);
    describe_flights(_scene, _peaks, rows, result);
    describe_bodies(_scene, rows, result);
    check_curves(wanted, rows, result);
  });
  check_profiles(result);
  return ExitCode::ok;
}

}  // namespace drogue::parachute_app
