#pragma once

#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/linear/batch_solve.hpp"

namespace drogue::options {

/// The equations of a step of an option: -lower x_{i-1} + diagonal x_i - upper x_{i+1} = right_i on the nodes
/// i = 1 .. n - 1 of a line, x_0 = edge, `lower` and `upper` of one sign or zero, diagonal > |lower| +
/// |upper|. The line goes on beyond its last node, where the right side is 0: there the diagonal is `pivot`.
struct Line {
  double lower, diagonal, upper, edge;
};

/// (d + sqrt(d^2 - 4 l u))/2: what elimination of an endless line leaves of every diagonal element.
[[nodiscard]] double pivot(const Line& line);

/// Lines of one length, a right side each.
struct Lines {
  int nodes = 0;  ///< n, 33 to 4096
  std::vector<Line> lines;
  std::vector<double> right;  ///< (lines, n); what stands at node 0 is not read
};

/// Solves them as a step of an option does, by the same two recurrences with constant factors (`workers.hpp`,
/// on a device with 128 or 256 nodes `register_march.hpp`), with nothing to exercise: what the solver of
/// options is held against other solvers by. Throws std::invalid_argument for a length out of range, a right
/// side of another size and a backend that is not compiled in.
[[nodiscard]] std::unique_ptr<linear::BatchSolve> create_line_solve(device::Backend backend,
                                                                    const Lines& lines);

}  // namespace drogue::options
