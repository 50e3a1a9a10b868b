#pragma once

#include "common/run/restart/restart_file.hpp"
#include "kernels/flow/state.hpp"

namespace drogue::parachute_app {

/// Ratio of a change to the value at the start; no change is none of a fluid at rest either. Does not throw.
[[nodiscard]] inline double relative(double change, double initial) {
  return change == 0.0 ? 0.0 : change / initial;
}

/// Extremes over the rows of a run, from its first start on. They continue after a restart.
class RunStatistics {
 public:
  /// Totals of the initial state.
  void begin(const flow::Totals& initial);

  /// Takes the totals of a row into account, unless a row of the same or a later step was.
  void add(const flow::Totals& totals);

  /// Largest rise of the kinetic energy between rows, relative to the initial energy.
  [[nodiscard]] double energy_growth() const { return relative(_largest_rise, _initial_energy); }

  /// Largest speed in any row over the initial one, less 1.
  [[nodiscard]] double speed_growth() const {
    return relative(_largest_speed - _initial_speed, _initial_speed);
  }

  /// Change of the momentum relative to sqrt(2 mass energy), which bounds it; `mass` in kg.
  [[nodiscard]] double momentum_change(const flow::Totals& totals, double mass) const;

  /// Largest rate at which the kinetic energy fell between two rows, W.
  [[nodiscard]] double peak_dissipation() const { return _peak_dissipation; }

  /// Time in the middle of these rows, s.
  [[nodiscard]] double peak_time() const { return _peak_time; }

  /// Root-mean-square divergence of the last row, 1/s.
  [[nodiscard]] double divergence() const { return _divergence; }

  /// Writes all members. Throws `Failure` (io_error).
  void write(run::RestartWriter& writer) const;

  /// Reads all members. Throws `Failure` (io_error).
  void read(const run::RestartReader& reader);

 private:
  template <class Self, class Number>
  static void visit(Self& self, const Number& number);

  double _initial_energy = 0.0, _initial_speed = 0.0, _initial_momentum[3] = {};
  double _step = 0.0, _time = 0.0, _energy = 0.0, _divergence = 0.0;  ///< of the last row
  double _largest_rise = 0.0, _largest_speed = 0.0, _peak_dissipation = 0.0, _peak_time = 0.0;
};

}  // namespace drogue::parachute_app
