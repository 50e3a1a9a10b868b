#include "common/grid/stretched_axis.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace drogue::grid {
namespace {

constexpr double most_cells = 1048576.0;  // 2^20
/// Relative difference of lengths that rounding explains.
constexpr double rounding = 1e-9;

struct Series {
  int cells = 0;
  double ratio = 1.0;
};

/// Sum of ratio^k for k = 1 to n.
double geometric_sum(double ratio, int n) {
  double sum = 0.0, power = 1.0;
  for (int k = 0; k < n; ++k) sum += power *= ratio;
  return sum;
}

/// Fewest cells that fill `length` widths of the core, each at most `growth` times as wide as the one before;
/// none if the first one would be narrower than those of the core.
std::optional<Series> series_of(double length, double growth) {
  if (length <= rounding) return Series{};
  Series series;
  double most = 0.0;
  for (double width = 1.0; most < length * (1.0 - rounding); ++series.cells) {
    if (series.cells >= most_cells) throw std::invalid_argument("more than 2^20 cells lie beside the core");
    most += width *= growth;
  }
  if (length < series.cells * (1.0 - rounding)) return std::nullopt;
  double low = 1.0, high = growth;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (geometric_sum(middle, series.cells) < length ? low : high) = middle;
  }
  series.ratio = 0.5 * (low + high);
  return series;
}

void check(const StretchedAxis& axis) {
  const auto require = [](bool holds, const char* condition) {
    if (!holds) throw std::invalid_argument(condition);
  };
  require(std::isfinite(axis.low) && std::isfinite(axis.high), "the ends of the domain must be finite");
  require(axis.low <= axis.core_low && axis.core_low < axis.core_high && axis.core_high <= axis.high,
          "the core must be an interval within the domain");
  require(axis.spacing > 0.0 && axis.core_high - axis.core_low <= most_cells * axis.spacing,
          "the spacing must be positive, and leave at most 2^20 cells");
  require(axis.growth > 1.0 && axis.growth <= 2.0, "the growth must be above 1 and at most 2");
}

}  // namespace

std::vector<double> stretched_faces(const StretchedAxis& axis) {
  check(axis);
  double low = axis.core_low, high = axis.core_high, spacing = 0.0;
  int cells = 0;
  std::optional<Series> below, above;
  while (!below || !above) {  // at most three times: each side is reached once
    cells = std::max(1, static_cast<int>(std::ceil((high - low) / axis.spacing * (1.0 - rounding))));
    spacing = (high - low) / cells;
    below = series_of((low - axis.low) / spacing, axis.growth);
    above = series_of((axis.high - high) / spacing, axis.growth);
    if (!below) low = axis.low;
    if (!above) high = axis.high;
  }
  const auto distances = [&](const Series& series) {
    std::vector<double> from_core;
    double sum = 0.0, power = 1.0;  // as in geometric_sum, for every number of cells
    for (int k = 0; k < series.cells; ++k) from_core.push_back(spacing * (sum += power *= series.ratio));
    return from_core;
  };
  std::vector<double> faces;
  const std::vector<double> to_low = distances(*below), to_high = distances(*above);
  for (std::size_t k = to_low.size(); k-- > 0;) faces.push_back(low - to_low[k]);
  for (int i = 0; i <= cells; ++i)
    faces.push_back(2 * i == cells  ? 0.5 * (low + high)
                    : 2 * i < cells ? low + i * spacing
                                    : high - (cells - i) * spacing);
  for (const double distance : to_high) faces.push_back(high + distance);
  faces.front() = axis.low;
  faces.back() = axis.high;
  return faces;
}

}  // namespace drogue::grid
