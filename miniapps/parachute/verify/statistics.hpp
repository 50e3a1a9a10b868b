#pragma once

#include "common/run/restart/restart_file.hpp"
#include "kernels/flow/solver.hpp"

namespace drogue::parachute_app {

/// Ratio of a change to the value at the start; no change is none of a fluid at rest either. Does not throw.
[[nodiscard]] inline double relative(double change, double initial) {
  return change == 0.0 ? 0.0 : change / initial;
}

/// State at the first start of a run, and extremes over all its steps since. They continue after a restart.
class RunStatistics {
 public:
  /// `watches_extremes`: as `flow::Parameters` of the solver.
  explicit RunStatistics(bool watches_extremes) : _watches_extremes(watches_extremes) {}

  /// Totals of the initial state.
  void begin(const flow::Totals& initial);

  /// Takes over the extremes of the solver.
  void update(const flow::Extremes& extremes) { _extremes = extremes; }

  /// Largest rise of the kinetic energy above its least value before, relative to the initial energy.
  [[nodiscard]] double energy_growth() const { return relative(_extremes.largest_rise, _initial_energy); }

  /// Largest speed after any step over the initial one, less 1.
  [[nodiscard]] double speed_growth() const {
    return relative(_extremes.largest_speed - _initial_speed, _initial_speed);
  }

  /// Change of the momentum relative to sqrt(2 mass energy), which bounds it; `mass` in kg.
  [[nodiscard]] double momentum_change(const flow::Totals& totals, double mass) const;

  /// Largest rate at which the kinetic energy fell in a step, W, and the time in its middle, s.
  [[nodiscard]] double peak_dissipation() const { return _extremes.peak_dissipation; }
  [[nodiscard]] double peak_time() const { return _extremes.peak_time; }

  /// Writes all members, with the extremes of the solver. Throws `Failure` (io_error).
  void write(run::RestartWriter& writer, flow::Solver& solver);

  /// Reads all members, and gives the solver the extremes. Throws `Failure` (io_error), also if the file
  /// lacks those that the scene verifies.
  void read(const run::RestartReader& reader, flow::Solver& solver);

 private:
  template <class Self, class Number, class Integer>
  static void visit(Self& self, const Number& number, const Integer& integer);

  bool _watches_extremes;
  double _initial_energy = 0.0, _initial_speed = 0.0, _initial_momentum[3] = {};
  flow::Extremes _extremes;
};

}  // namespace drogue::parachute_app
