#include "miniapps/parachute/verify/canopy_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/run/history_statistics.hpp"
#include "common/run/statistics.hpp"

namespace drogue::parachute_app {
namespace {

/// Mean and root mean square of the flow through a canopy over the product of the means of its airspeed and
/// projected area, and the number of rows. NaN if the product is 0.
struct Leak {
  double mean, rms;
  std::size_t rows;
};

Leak leak_of(const CanopyLeak& wanted, const run::History& history) {
  const std::vector<double>& time = history.at("time");
  const auto mean = [&](const std::vector<double>& values) {
    return run::mean_between({time, values}, wanted.from, wanted.to);
  };
  const auto column = [&](const char* name) -> const std::vector<double>& {
    return history.at("canopy_" + std::to_string(wanted.canopy) + name);
  };
  const std::vector<double>& leak = column("_leak");
  std::vector<double> square(leak.size());
  std::ranges::transform(leak, square.begin(), [](double value) { return value * value; });
  double product = mean(column("_airspeed")) * mean(column("_projected_area"));
  if (!(product > 0.0)) product = std::numeric_limits<double>::quiet_NaN();
  return {std::abs(mean(leak)) / product, std::sqrt(mean(square)) / product,
          run::rows_between({time, leak}, wanted.from, wanted.to).time.size()};
}

}  // namespace

run::History rows_of(const FlowScene& scene, const run::RunDirectory* directory) {
  const bool has_means = scene.has_fluid() && scene.output.history_every > 0 &&
                         (!scene.bodies.empty() || std::ranges::any_of(scene.canopies, &Canopy::has_lines));
  return has_means || scene.verify.needs_rows() ? run::read_history(directory->file("history.csv"))
                                                : run::History{};
}

void check_canopies(const Verify& wanted, const PeakPulls& peaks, const run::History& history,
                    run::ResultDocument& result) {
  for (std::size_t i = 0; i < wanted.leaks.size(); ++i) {
    const Leak leak = leak_of(wanted.leaks[i], history);
    const auto check = [&](const std::string& name, double value, std::optional<double> tolerance) {
      result.metrics.set("canopies", name, value);
      if (!tolerance) return;
      result.add_check(name, value, *tolerance);
      result.state_rows(leak.rows);
    };
    check("leak_" + std::to_string(i), leak.mean, wanted.leaks[i].tolerance);
    check("leak_rms_" + std::to_string(i), leak.rms, wanted.leaks[i].rms_tolerance);
  }
  // A value passes between two bounds if its distance from their mean is at most half of theirs.
  const auto check_bounds = [&](const std::string& name, double value, const std::array<double, 2>& bounds) {
    result.metrics.set("canopies", name, value);
    result.add_check(name, std::abs(value - 0.5 * (bounds[0] + bounds[1])), 0.5 * (bounds[1] - bounds[0]),
                     run::Measurement{value, bounds[0], bounds[1]});
  };
  for (std::size_t i = 0; i < wanted.peak_forces.size(); ++i) {
    const CanopyPeak& peak = wanted.peak_forces[i];
    const auto [force, time] = peaks.values().at(static_cast<std::size_t>(peak.canopy));
    const std::string name = "peak_force_" + std::to_string(i);
    check_bounds(name, force, peak.force);
    result.metrics.set("canopies", name + "_time", time);
    if (peak.time) check_bounds(name + "_time", time, *peak.time);
  }
  const auto check_largest = [&](const std::string& column, std::optional<double> tolerance) {
    if (!tolerance) return;
    const run::HistoryRows rows{history.at("time"), history.at(column)};
    const double begin = rows.time.empty() ? 0.0 : rows.time.front();
    result.add_check(column, run::statistic_of(run::Statistic::max, rows, begin, run::never), *tolerance);
    result.state_rows(rows.time.size());
  };
  check_largest("force_balance", wanted.force_balance);
  check_largest("intersections", wanted.intersections);
}

void check_energy_drift(const FlowScene& scene, const run::History& history, run::ResultDocument& result) {
  if (!scene.verify.energy_drift) return;
  const std::vector<double>&energy = history.at("energy"), &kinetic = history.at("cloth_kinetic_energy"),
        &elastic = history.at("cloth_elastic_energy");
  double change = 0.0, scale = 0.0;
  for (const Canopy& canopy : scene.canopies)
    scale += 0.5 * canopy.membrane_modulus * least_strain * least_strain * canopy.nominal_area();
  for (std::size_t k = 0; k < energy.size(); ++k) {
    change = run::maximum_or_nan(change, std::abs(energy[k] - energy[0]));
    scale = std::max(scale, kinetic[k] + elastic[k]);
  }
  result.add_check("energy_drift", change / scale, *scene.verify.energy_drift);
  result.state_rows(energy.size());
}

}  // namespace drogue::parachute_app
