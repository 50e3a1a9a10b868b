#include "miniapps/parachute/verify/statistics.hpp"

#include <cmath>
#include <string>

#include "common/run/statistics.hpp"

namespace drogue::parachute_app {

template <class Self, class Number>
void RunStatistics::visit(Self& self, const Number& number) {
  number("initial_energy", self._initial_energy);
  number("initial_speed", self._initial_speed);
  for (int axis = 0; axis < 3; ++axis)
    number("initial_momentum_" + std::to_string(axis), self._initial_momentum[axis]);
  number("row_step", self._step);
  number("row_time", self._time);
  number("row_energy", self._energy);
  number("row_divergence", self._divergence);
  number("largest_rise", self._largest_rise);
  number("largest_speed", self._largest_speed);
  number("peak_dissipation", self._peak_dissipation);
  number("peak_time", self._peak_time);
}

void RunStatistics::begin(const flow::Totals& initial) {
  *this = {};
  _initial_energy = _energy = initial.kinetic_energy;
  _initial_speed = _largest_speed = initial.max_speed;
  for (int axis = 0; axis < 3; ++axis) _initial_momentum[axis] = initial.momentum[axis];
  _divergence = initial.divergence_rms;
}

void RunStatistics::add(const flow::Totals& totals) {
  const auto step = static_cast<double>(totals.step);
  if (step <= _step) return;
  const double rise = totals.kinetic_energy - _energy, rate = -rise / (totals.time - _time);
  _largest_rise = run::maximum_or_nan(_largest_rise, rise);
  _largest_speed = run::maximum_or_nan(_largest_speed, totals.max_speed);
  if (rate > _peak_dissipation || std::isnan(rate)) {
    _peak_dissipation = rate;
    _peak_time = 0.5 * (totals.time + _time);
  }
  _step = step;
  _time = totals.time;
  _energy = totals.kinetic_energy;
  _divergence = totals.divergence_rms;
}

double RunStatistics::momentum_change(const flow::Totals& totals, double mass) const {
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) square += std::pow(totals.momentum[axis] - _initial_momentum[axis], 2);
  return relative(std::sqrt(square), std::sqrt(2.0 * mass * _initial_energy));
}

void RunStatistics::write(run::RestartWriter& writer) const {
  visit(*this, [&](const std::string& name, double value) { writer.number(name, value); });
}

void RunStatistics::read(const run::RestartReader& reader) {
  visit(*this, [&](const std::string& name, double& value) { value = reader.number(name); });
}

}  // namespace drogue::parachute_app
