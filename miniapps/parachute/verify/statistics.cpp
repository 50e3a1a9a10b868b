#include "miniapps/parachute/verify/statistics.hpp"

#include <cmath>
#include <string>

#include "common/program/failure.hpp"

namespace drogue::parachute_app {

template <class Self, class Number, class Integer>
void RunStatistics::visit(Self& self, const Number& number, const Integer& integer) {
  number("initial_energy", self._initial_energy);
  number("initial_speed", self._initial_speed);
  for (int axis = 0; axis < 3; ++axis)
    number("initial_momentum_" + std::to_string(axis), self._initial_momentum[axis]);
  auto& extremes = self._extremes;
  integer("extremes_step", extremes.step);
  number("extremes_time", extremes.time);
  number("extremes_energy", extremes.energy);
  number("least_energy", extremes.least_energy);
  number("largest_rise", extremes.largest_rise);
  number("largest_speed", extremes.largest_speed);
  number("peak_dissipation", extremes.peak_dissipation);
  number("peak_time", extremes.peak_time);
}

void RunStatistics::begin(const flow::Totals& initial) {
  _initial_energy = initial.kinetic_energy;
  _initial_speed = initial.max_speed;
  for (int axis = 0; axis < 3; ++axis) _initial_momentum[axis] = initial.momentum[axis];
}

double RunStatistics::momentum_change(const flow::Totals& totals, double mass) const {
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) square += std::pow(totals.momentum[axis] - _initial_momentum[axis], 2);
  return relative(std::sqrt(square), std::sqrt(2.0 * mass * _initial_energy));
}

void RunStatistics::write(run::RestartWriter& writer, flow::Solver& solver) {
  update(solver.extremes());
  visit(
      *this, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, std::int64_t value) { writer.integer(name, value); });
}

void RunStatistics::read(const run::RestartReader& reader, flow::Solver& solver) {
  visit(
      *this, [&](const std::string& name, double& value) { value = reader.number(name); },
      [&](const std::string& name, std::int64_t& value) { value = reader.integer(name); });
  if (!_watches_extremes) return;
  if (_extremes.step < 0)
    throw Failure(
        ExitCode::io_error,
        "verify: the run that wrote the restart file kept no extremes of its steps, since its scene "
        "lacked energy_growth, speed_growth and dissipation_peak; start anew, or leave them out");
  solver.set_extremes(_extremes);
}

}  // namespace drogue::parachute_app
