#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "kernels/flow/parameters.hpp"

namespace drogue::testing {

/// Gives the cells of an axis widths in these proportions.
inline void set_widths(flow::Parameters& p, std::size_t axis, const std::vector<double>& widths) {
  double sum = 0.0, end = 0.0;
  for (const double width : widths) sum += width;
  p.faces[axis] = {p.low[axis]};
  for (const double width : widths)
    p.faces[axis].push_back(p.low[axis] + (end += width) / sum * (p.high[axis] - p.low[axis]));
  p.faces[axis].back() = p.high[axis];
}

/// Gives the cells of all axes of several cells random widths, the ratio of any two at most `ratio`.
inline void set_random_widths(flow::Parameters& p, double ratio, unsigned seed) {
  std::mt19937 engine(seed);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p.cells[axis] == 1) continue;
    std::vector<double> widths(static_cast<std::size_t>(p.cells[axis]));
    for (double& width : widths) width = std::pow(ratio, std::generate_canonical<double, 53>(engine));
    set_widths(p, axis, widths);
  }
}

/// Gives an axis a core of `core` cells in the middle, beside which the widths grow by `growth` from cell to
/// cell up to `ratio`.
inline void set_graded_widths(flow::Parameters& p, std::size_t axis, int core, double growth, double ratio) {
  const int n = p.cells[axis], side = (n - core) / 2;
  std::vector<double> widths;
  for (int i = 0; i < n; ++i)
    widths.push_back(std::min(ratio, std::pow(growth, std::max({0, side - i, i - (n - 1 - side)}))));
  set_widths(p, axis, widths);
}

}  // namespace drogue::testing
