#include "kernels/reference/linear/laplacian.hpp"

namespace drogue::reference {

std::vector<double> laplacian(const CellBox& box, const std::vector<double>& values) {
  std::vector<double> result(values.size(), 0.0);
  const auto [nx, ny, nz] = box.cells;
  const auto at = [&](const std::array<int, 3>& cell) {
    return static_cast<std::size_t>((cell[2] * ny + cell[1]) * nx + cell[0]);
  };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::array<int, 3> cell{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const int n = box.cells[axis];
          if (n == 1) continue;
          const double h = box.spacing[axis], own = values[at(cell)];
          for (const int step : {-1, 1}) {
            std::array<int, 3> next = cell;
            next[axis] += step;
            const End end = box.ends[axis][step < 0 ? 0 : 1];
            double difference = 0.0;
            if (next[axis] >= 0 && next[axis] < n)
              difference = values[at(next)] - own;
            else if (end == End::periodic)
              next[axis] = (next[axis] + n) % n, difference = values[at(next)] - own;
            else if (end == End::dirichlet)
              difference = -2.0 * own;  // the face is half a cell away
            result[at(cell)] += difference / (h * h);
          }
        }
      }
  return result;
}

}  // namespace drogue::reference
