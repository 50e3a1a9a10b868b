#include "kernels/reference/linear/tridiagonal.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace drogue::reference {

std::vector<double> solve_tridiagonal(const std::vector<double>& below, const std::vector<double>& diagonal,
                                      const std::vector<double>& above, const std::vector<double>& right) {
  const std::size_t n = diagonal.size();
  // Columns i, i + 1, i + 2 of row i and its right side. An exchange of rows fills the third column.
  using Row = std::array<long double, 4>;
  const auto row = [&](std::size_t i, bool with_below) {
    const long double after = i + 1 < n ? above[i] : 0.0L;
    return with_below ? Row{below[i], diagonal[i], after, right[i]} : Row{diagonal[i], after, 0.0L, right[i]};
  };
  std::vector<Row> rows(n);
  if (n > 0) rows[0] = row(0, false);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    Row next = row(i + 1, true);
    if (std::abs(next[0]) > std::abs(rows[i][0])) std::swap(next, rows[i]);
    const long double factor = next[0] / rows[i][0];
    rows[i + 1] = {next[1] - factor * rows[i][1], next[2] - factor * rows[i][2], 0.0L,
                   next[3] - factor * rows[i][3]};
  }
  std::vector<long double> x(n + 2, 0.0L);
  for (std::size_t i = n; i-- > 0;)
    x[i] = (rows[i][3] - rows[i][1] * x[i + 1] - rows[i][2] * x[i + 2]) / rows[i][0];
  return {x.begin(), x.end() - 2};
}

}  // namespace drogue::reference
