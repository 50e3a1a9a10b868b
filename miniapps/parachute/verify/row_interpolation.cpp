#include "miniapps/parachute/verify/row_interpolation.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace drogue::parachute_app {

InterpolatedRow interpolate_rows(const std::vector<double>& time, const std::vector<double>& value,
                                 double at) {
  constexpr std::size_t rows = 4;
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  if (time.size() < rows || !(at >= time.front() && at <= time.back())) return {not_a_number, not_a_number};
  const auto above = static_cast<std::size_t>(std::ranges::lower_bound(time, at) - time.begin());
  const std::size_t first = std::min(above < 2 ? 0 : above - 2, time.size() - rows);

  // Newton's divided differences: c[k] multiplies the product of the distances to the first k rows.
  std::array<double, rows> c{};
  for (std::size_t i = 0; i < rows; ++i) c[i] = value[first + i];
  for (std::size_t order = 1; order < rows; ++order)
    for (std::size_t i = rows - 1; i >= order; --i)
      c[i] = (c[i] - c[i - 1]) / (time[first + i] - time[first + i - order]);

  double polynomial = c[rows - 1], slope = 0.0;
  for (std::size_t i = rows - 1; i-- > 0;) {
    const double distance = at - time[first + i];
    slope = slope * distance + polynomial;
    polynomial = polynomial * distance + c[i];
  }
  return {polynomial, slope};
}

}  // namespace drogue::parachute_app
