#include "kernels/options/line_solve.hpp"

#include <cmath>
#include <stdexcept>

namespace drogue::options {

double pivot(const Line& line) {
  return 0.5 * (line.diagonal + std::sqrt(line.diagonal * line.diagonal - 4.0 * line.lower * line.upper));
}

// Defined in line_solve_on.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<linear::BatchSolve> make_line_solve(const Lines& lines);

std::unique_ptr<linear::BatchSolve> create_line_solve(device::Backend backend, const Lines& lines) {
  if (lines.nodes < 33 || lines.nodes > 4096)
    throw std::invalid_argument("lines: the number of nodes must be from 33 to 4096");
  if (lines.lines.empty() || lines.right.size() != lines.lines.size() * static_cast<std::size_t>(lines.nodes))
    throw std::invalid_argument("lines: every line needs a right side of as many numbers as nodes");
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_line_solve<ExecutionSpace>(lines); });
}

}  // namespace drogue::options
