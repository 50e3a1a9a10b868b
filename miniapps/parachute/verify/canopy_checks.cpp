#include "miniapps/parachute/verify/canopy_checks.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/history_reader.hpp"
#include "common/run/statistics.hpp"
#include "miniapps/parachute/verify/force_history.hpp"
#include "miniapps/parachute/verify/target.hpp"

namespace drogue::parachute_app {

void check_canopies(const Verify& wanted, const CanopyRecord& record, run::ResultDocument& result) {
  const auto check_mean = [&](const std::string& name, double value, const CanopyMean& mean) {
    result.metrics.set("canopies", name, value);
    check_target(result, name, value, mean.target);
    result.state_rows(record.rows(mean.from, mean.to));
  };
  for (std::size_t i = 0; i < wanted.drags.size(); ++i) {
    const CanopyMean& drag = wanted.drags[i];
    check_mean("drag_" + std::to_string(i),
               record.mean_drag(static_cast<std::size_t>(drag.canopy), drag.from, drag.to), drag);
  }
  for (std::size_t i = 0; i < wanted.terminal_speeds.size(); ++i) {
    const CanopyMean& speed = wanted.terminal_speeds[i];
    check_mean("terminal_speed_" + std::to_string(i),
               record.mean_speed(static_cast<std::size_t>(speed.canopy), speed.from, speed.to), speed);
  }
  for (std::size_t i = 0; i < wanted.projected_areas.size(); ++i) {
    const CanopyMean& area = wanted.projected_areas[i];
    check_mean("projected_area_" + std::to_string(i),
               record.mean_area(static_cast<std::size_t>(area.canopy), area.from, area.to), area);
  }
  for (std::size_t i = 0; i < wanted.leaks.size(); ++i) {
    const CanopyLeak& leak = wanted.leaks[i];
    const std::string name = "leak_" + std::to_string(i);
    const auto canopy = static_cast<std::size_t>(leak.canopy);
    const double value = record.relative_leak(canopy, leak.from, leak.to),
                 rms = record.relative_leak_rms(canopy, leak.from, leak.to);
    result.metrics.set("canopies", name, value);
    result.add_check(name, value, leak.tolerance);
    result.state_rows(record.rows(leak.from, leak.to));
    const std::string name_of_rms = "leak_rms_" + std::to_string(i);
    result.metrics.set("canopies", name_of_rms, rms);
    if (!leak.rms_tolerance) continue;
    result.add_check(name_of_rms, rms, *leak.rms_tolerance);
    result.state_rows(record.rows(leak.from, leak.to));
  }
  // A value passes between two bounds if its distance from their mean is at most half of theirs.
  const auto check_bounds = [&](const std::string& name, double value, const std::array<double, 2>& bounds) {
    result.metrics.set("canopies", name, value);
    result.add_check(name, std::abs(value - 0.5 * (bounds[0] + bounds[1])), 0.5 * (bounds[1] - bounds[0]),
                     run::Measurement{value, bounds[0], bounds[1]});
  };
  for (std::size_t i = 0; i < wanted.peak_forces.size(); ++i) {
    const CanopyPeak& peak = wanted.peak_forces[i];
    const auto [force, time] = record.peaks().at(static_cast<std::size_t>(peak.canopy));
    const std::string name = "peak_force_" + std::to_string(i);
    check_bounds(name, force, peak.force);
    result.metrics.set("canopies", name + "_time", time);
    if (peak.time) check_bounds(name + "_time", time, *peak.time);
  }
  const auto check_largest = [&](const std::string& name, double value, std::optional<double> tolerance) {
    if (!tolerance) return;
    result.add_check(name, value, *tolerance);
    result.state_rows(record.rows());
  };
  check_largest("force_balance", record.balance(), wanted.force_balance);
  check_largest("intersections", record.intersections(), wanted.intersections);
}

void check_oscillations(const Verify& checks, const run::RunDirectory* directory,
                        run::ResultDocument& result) {
  if (checks.oscillations.empty()) return;
  const run::History history = run::read_history(directory->file("history.csv"));
  const std::vector<double>& time = history.at("time");
  for (std::size_t i = 0; i < checks.oscillations.size(); ++i) {
    const Oscillation& wanted = checks.oscillations[i];
    const std::vector<double>& place = history.at(wanted.column);
    const std::size_t rows = rows_from(time, wanted.from);
    const double frequency = frequency_from(time, place, wanted.from),
                 period = rows_in_period(time, wanted.from, frequency);
    const auto check = [&](const std::string& name, double value, const std::optional<Target>& target) {
      result.metrics.set("oscillations", name + "_" + std::to_string(i), value);
      if (!target) return;
      check_target(result, name + "_of_oscillation_" + std::to_string(i), value, *target);
      result.state_rows(rows, period);
    };
    check("frequency", frequency, wanted.frequency);
    check("amplitude", amplitude_from(time, place, wanted.from), wanted.amplitude);
  }
}

void check_energy_drift(const FlowScene& scene, const run::RunDirectory* directory,
                        run::ResultDocument& result) {
  if (!scene.verify.energy_drift) return;
  const run::History history = run::read_history(directory->file("history.csv"));
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
