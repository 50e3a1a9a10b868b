#include "miniapps/parachute/verify/canopy_record.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "common/program/failure.hpp"
#include "common/run/statistics.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

double length_of(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

CanopyRecord::CanopyRecord(const FlowScene& scene, bool watches_pulls)
    : _scene(scene),
      _watches_pulls(watches_pulls),
      _columns(first_column + per_canopy * scene.canopies.size()),
      _peaks(scene.canopies.size()) {
  if (scene.canopies.empty()) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    _stream[axis] = SpaceTimeFunction(scene.velocity[axis]).constant().value_or(0.0);
}

void CanopyRecord::add(std::int64_t step, double time, const std::vector<CanopyMeasures>& canopies,
                       double balance, double intersections) {
  if (!has_row(step, time)) return;
  if (!_values.empty() && time <= at(rows() - 1, 0)) return;
  _values.insert(_values.end(), {time, balance, intersections});
  for (std::size_t i = 0; i < canopies.size(); ++i) {
    const CanopyMeasures& canopy = canopies[i];
    Vector u = _stream;
    double along = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      u[axis] -= canopy.velocity[axis];
      along += canopy.force[axis] * u[axis];
    }
    const double speed = length_of(u), pressure = 0.5 * _scene.parameters.density * speed * speed;
    const double drag = along == 0.0 ? 0.0 : along / (speed * pressure * _scene.canopies[i].nominal_area());
    _values.insert(_values.end(), {drag, speed, canopy.projected_area, canopy.leak});
  }
}

std::size_t CanopyRecord::rows(double from, double to) const {
  std::size_t count = 0;
  for (std::size_t row = 0; row < rows(); ++row) count += at(row, 0) >= from && at(row, 0) <= to ? 1 : 0;
  return count;
}

template <class Value>
double CanopyRecord::mean_of(const Value& value, double from, double to) const {
  double integral = 0.0, first = std::numeric_limits<double>::quiet_NaN(), last = first;
  for (std::size_t row = 0; row < rows(); ++row) {
    const double time = at(row, 0);
    if (time < from || time > to) continue;
    if (std::isnan(first)) first = time;
    if (!std::isnan(last)) integral += 0.5 * (time - last) * (value(row - 1) + value(row));
    last = time;
  }
  return integral / (last - first);
}

double CanopyRecord::mean(std::size_t column, double from, double to) const {
  return mean_of([&](std::size_t row) { return at(row, column); }, from, to);
}

double CanopyRecord::mean_square(std::size_t column, double from, double to) const {
  return mean_of([&](std::size_t row) { return at(row, column) * at(row, column); }, from, to);
}

double CanopyRecord::reference_flow(std::size_t canopy, double from, double to) const {
  const double product = mean_speed(canopy, from, to) * mean_area(canopy, from, to);
  return product > 0.0 ? product : std::numeric_limits<double>::quiet_NaN();
}

double CanopyRecord::relative_leak(std::size_t canopy, double from, double to) const {
  return std::abs(mean(column(Measure::leak, canopy), from, to)) / reference_flow(canopy, from, to);
}

double CanopyRecord::relative_leak_rms(std::size_t canopy, double from, double to) const {
  return std::sqrt(mean_square(column(Measure::leak, canopy), from, to)) / reference_flow(canopy, from, to);
}

double CanopyRecord::largest(std::size_t column) const {
  double result = 0.0;
  for (std::size_t row = 0; row < rows(); ++row) result = run::maximum_or_nan(result, at(row, column));
  return result;
}

double CanopyRecord::balance() const { return largest(1); }

double CanopyRecord::intersections() const { return largest(2); }

void CanopyRecord::write(run::RestartWriter& writer) const {
  writer.integer("watches_pulls", _watches_pulls ? 1 : 0);
  for (std::size_t i = 0; i < _peaks.size(); ++i) {
    writer.number("peak_force_" + std::to_string(i), _peaks[i].force);
    writer.number("peak_force_time_" + std::to_string(i), _peaks[i].time);
  }
  writer.number("canopy_rows", static_cast<double>(rows()));
  if (_values.empty()) return;
  writer.array("canopy_record", _values.size());
  writer.write("canopy_record", 0, _values);
}

void CanopyRecord::read(const run::RestartReader& reader, std::int64_t step, double time) {
  if (_watches_pulls && reader.integer("watches_pulls") == 0)
    throw Failure(ExitCode::io_error,
                  "verify.peak_force: the run that wrote the restart file kept no largest forces, since its "
                  "scene lacked the key; start anew, or leave the key out");
  for (std::size_t i = 0; i < _peaks.size(); ++i)
    _peaks[i] = {reader.number("peak_force_" + std::to_string(i)),
                 reader.number("peak_force_time_" + std::to_string(i))};
  _values.resize(static_cast<std::size_t>(reader.number("canopy_rows")) * _columns);
  if (_values.empty()) return;
  reader.read("canopy_record", 0, _values);
  // The row at the former end of the run.
  if (at(rows() - 1, 0) == time && !has_row(step, time)) _values.resize(_values.size() - _columns);
}

}  // namespace drogue::parachute_app
