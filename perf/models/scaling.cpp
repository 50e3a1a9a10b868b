#include "perf/models/scaling.hpp"

#include <numbers>

#include "perf/rows/printed.hpp"

namespace drogue::perf {

std::vector<int> unit_counts(int most) {
  std::vector<int> counts = {1};
  while (2 * counts.back() < most) counts.push_back(2 * counts.back());
  if (most > 1) counts.push_back(most);
  return counts;
}

double efficiency(bool weak, double of_one, double time, int units) {
  return weak ? of_one / time : of_one / time / units;
}

std::array<int, 3> scaled_cells(const std::array<int, 3>& one, bool weak, int units) {
  return {one[0], one[1], weak ? one[2] * units : one[2]};
}

std::string flow_scene(const std::array<int, 3>& cells, int steps) {
  constexpr double length = 2.0 * std::numbers::pi, dt = 0.002;
  const double h = length / cells[0];
  // The error is of second order: ten times that of 20 steps, and far below the change by a wrong term.
  return printed(
      "app = \"parachute\"\n"
      "[fluid]\ndensity = 1.0\nviscosity = 0.01\n"
      "[grid]\ncells = [%d, %d, %d]\ndomain = [[0, %.17g], [0, %.17g], [0, %.17g]]\n"
      "boundary = { x = \"periodic\", y = \"periodic\", z = \"periodic\" }\n"
      "[initial]\nvelocity = [\"1 + sin(x)*cos(y)\", \"0.5 - cos(x)*sin(y)\", 0.25]\n"
      "[flow]\ntime = \"ab2\"\n"
      "[run]\ndt = %.17g\nend_time = %.17g\n"
      "[output]\nfields = []\nrestart_every = 0\n"
      "[verify]\n"
      "exact = { x = \"1 + sin(x-t)*cos(y-0.5*t)*exp(-0.02*t)\", "
      "y = \"0.5 - cos(x-t)*sin(y-0.5*t)*exp(-0.02*t)\", z = 0.25 }\n"
      "l2_velocity = %.3g\ndivergence = 1e-10\n",
      cells[0], cells[1], cells[2], length, h * cells[1], h * cells[2], dt, steps * dt, 5e-5 * steps * h * h);
}

}  // namespace drogue::perf
