#include "kernels/options/line_solve.hpp"

#include <cmath>
#include <stdexcept>

namespace drogue::options {

double pivot(const Line& line) {
  return 0.5 * (line.diagonal + std::sqrt(line.diagonal * line.diagonal - 4.0 * line.lower * line.upper));
}

#define DROGUE_DECLARE(backend) \
  std::unique_ptr<linear::BatchSolve> create_line_solve_##backend(const Lines& lines);
DROGUE_FOR_EACH_BACKEND(DROGUE_DECLARE)
#undef DROGUE_DECLARE

std::unique_ptr<linear::BatchSolve> create_line_solve(device::Backend backend, const Lines& lines) {
  if (lines.nodes < 33 || lines.nodes > 4096)
    throw std::invalid_argument("lines: the number of nodes must be from 33 to 4096");
  if (lines.lines.empty() || lines.right.size() != lines.lines.size() * static_cast<std::size_t>(lines.nodes))
    throw std::invalid_argument("lines: every line needs a right side of as many numbers as nodes");
  switch (backend) {
#define DROGUE_CREATE(name)   \
  case device::Backend::name: \
    return create_line_solve_##name(lines);
    DROGUE_FOR_EACH_BACKEND(DROGUE_CREATE)
#undef DROGUE_CREATE
    default:
      throw std::invalid_argument("lines: this build lacks the backend");
  }
}

}  // namespace drogue::options
