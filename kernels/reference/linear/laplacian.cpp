#include "kernels/reference/linear/laplacian.hpp"

namespace drogue::reference {

namespace {

/// Distances along one axis, m.
struct Axis {
  const CellBox& box;
  std::size_t axis;

  [[nodiscard]] bool is_periodic() const { return box.ends[axis][0] == End::periodic; }
  /// Width of a cell; the first of a periodic axis follows the last.
  [[nodiscard]] double width(int cell) const {
    const std::vector<double>& widths = box.widths[axis];
    if (widths.empty()) return box.spacing[axis];
    const int n = static_cast<int>(widths.size());
    return widths[static_cast<std::size_t>((cell + n) % n)];
  }
  /// Cell on the low side of the value at a face.
  [[nodiscard]] int cell_below(int value) const { return is_periodic() ? value - 1 : value; }
  /// Length of the control volume of a value.
  [[nodiscard]] double length(int value) const {
    if (!box.on_faces[axis]) return width(value);
    const int below = cell_below(value);
    return 0.5 * (width(below) + width(below + 1));
  }
  /// Distance to the next value towards `step`, or to an end if there is none.
  [[nodiscard]] double distance(int value, int step, bool is_end) const {
    if (box.on_faces[axis]) return width(cell_below(value) + (step < 0 ? 0 : 1));
    return 0.5 * (is_end ? width(value) : width(value) + width(value + step));
  }
};

}  // namespace

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
        for (std::size_t a = 0; a < 3; ++a) {
          const Axis axis{box, a};
          const int n = box.cells[a];
          if (n == 1 && (!box.on_faces[a] || axis.is_periodic())) continue;
          for (const int step : {-1, 1}) {
            std::array<int, 3> next = cell;
            next[a] += step;
            const bool is_end = !axis.is_periodic() && (next[a] < 0 || next[a] >= n);
            if (is_end && !box.on_faces[a] && box.ends[a][step < 0 ? 0 : 1] == End::neumann) continue;
            next[a] = (next[a] + n) % n;
            const double other = is_end ? 0.0 : values[at(next)];
            result[at(cell)] +=
                (other - values[at(cell)]) / (axis.distance(cell[a], step, is_end) * axis.length(cell[a]));
          }
        }
      }
  return result;
}

}  // namespace drogue::reference
