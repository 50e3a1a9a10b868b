#pragma once

#include <cstdint>
#include <vector>

#include "common/run/restart/restart_file.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Forces and speeds of the canopies in all rows of a run, from its first start on. A run that continues has
/// them from its restart file, also for other intervals of time in [verify].
class CanopyRecord {
 public:
  /// Keeps a reference to `scene`. `watches_pulls`: whether the solver records the largest forces.
  CanopyRecord(const FlowScene& scene, bool watches_pulls);

  /// Lets a solver of cloth record the largest forces of lines on payloads, before its start. Throws as its
  /// `watch_pulls`.
  template <class Solver>
  void watch(Solver& solver, const Sheets& sheets) const {
    if (_watches_pulls) solver.watch_pulls(pulls_on_payloads(sheets));
  }

  /// Takes over the largest forces from the solver. Throws as its `peak_pulls`.
  template <class Solver>
  void update_peaks(Solver& solver) {
    if (_watches_pulls) _peaks = solver.peak_pulls();
  }

  /// Adds a row of a step and its time, s, unless there is one of the same or a later time, or the run of the
  /// whole has no row there. `balance`: `force_balance`; `intersections`: their number, or 0.
  void add(std::int64_t step, double time, const std::vector<CanopyMeasures>& canopies, double balance,
           double intersections);

  /// Mean drag coefficient 2 F / (rho U^2 S0) of the rows in [from, to], s: trapezoidal rule. F is the force
  /// along U, the velocity of the fluid far upstream relative to the payload; S0 the nominal area. NaN with
  /// fewer than two rows. Does not throw.
  [[nodiscard]] double mean_drag(std::size_t canopy, double from, double to) const {
    return mean(column(Measure::drag, canopy), from, to);
  }

  /// Mean magnitude of U, m/s, likewise.
  [[nodiscard]] double mean_speed(std::size_t canopy, double from, double to) const {
    return mean(column(Measure::speed, canopy), from, to);
  }

  /// Mean projected area, m^2, likewise.
  [[nodiscard]] double mean_area(std::size_t canopy, double from, double to) const {
    return mean(column(Measure::projected_area, canopy), from, to);
  }

  /// Magnitude of the mean leak over the mean speed and the mean projected area, likewise. What flows in and
  /// out of a canopy that breathes cancels. NaN also where speed or area are zero.
  [[nodiscard]] double relative_leak(std::size_t canopy, double from, double to) const;

  /// Root mean square of the leak, likewise: in and out add up.
  [[nodiscard]] double relative_leak_rms(std::size_t canopy, double from, double to) const;

  /// Number of rows, also of those in [from, to], s. Does not throw.
  [[nodiscard]] std::size_t rows() const { return _values.size() / _columns; }
  [[nodiscard]] std::size_t rows(double from, double to) const;

  /// Largest force of the lines on each payload in all steps up to the last update. Does not throw.
  [[nodiscard]] const std::vector<fabric::PeakPull>& peaks() const { return _peaks; }

  /// Largest `force_balance`. Does not throw.
  [[nodiscard]] double balance() const;

  /// Largest number of intersections. Does not throw.
  [[nodiscard]] double intersections() const;

  /// Writes all rows, and the largest forces of the solver. Throws `Failure` (io_error).
  template <class Solver>
  void write(run::RestartWriter& writer, Solver& solver) {
    update_peaks(solver);
    write(writer);
  }

  /// Reads all rows up to a step and its time, s, and gives the solver the largest forces. Throws `Failure`
  /// (io_error), also if the file lacks forces that the scene verifies.
  template <class Solver>
  void read(const run::RestartReader& reader, std::int64_t step, double time, Solver& solver) {
    read(reader, step, time);
    if (_watches_pulls) solver.set_peak_pulls(_peaks);
  }

 private:
  /// Columns of a canopy, in this order.
  enum class Measure : std::size_t { drag, speed, projected_area, leak, count };
  static constexpr std::size_t first_column = 3, per_canopy = static_cast<std::size_t>(Measure::count);

  static constexpr std::size_t column(Measure measure, std::size_t canopy) {
    return first_column + per_canopy * canopy + static_cast<std::size_t>(measure);
  }
  [[nodiscard]] double largest(std::size_t column) const;
  void write(run::RestartWriter& writer) const;
  void read(const run::RestartReader& reader, std::int64_t step, double time);
  /// True if a run without interruption has a row after a step, at a time, s: every `history_every` steps and
  /// at its end.
  [[nodiscard]] bool has_row(std::int64_t step, double time) const {
    const int every = _scene.output.history_every;
    return (every > 0 && step % every == 0) || time >= _scene.end_time;
  }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return _values[row * _columns + column];
  }
  [[nodiscard]] double mean(std::size_t column, double from, double to) const;
  [[nodiscard]] double mean_square(std::size_t column, double from, double to) const;
  template <class Value>
  [[nodiscard]] double mean_of(const Value& value, double from, double to) const;
  /// Mean speed times mean projected area, m^3/s; NaN if zero.
  [[nodiscard]] double reference_flow(std::size_t canopy, double from, double to) const;

  const FlowScene& _scene;
  const bool _watches_pulls;
  fabric::Vector _stream{};  ///< velocity of the fluid far upstream, m/s
  std::size_t _columns;
  /// Row by row: time, balance, intersections; then the measures of each canopy.
  std::vector<double> _values;
  std::vector<fabric::PeakPull> _peaks;  ///< one per canopy
};

}  // namespace drogue::parachute_app
