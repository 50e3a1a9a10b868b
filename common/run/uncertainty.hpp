#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

/// Error bars of 95 % of means over time, of means over runs, and of limits of fine grids.
namespace drogue::run {

/// Number of batches in which the mean of a correlated series is examined.
inline constexpr std::size_t batches = 16;

/// Assumed order of the error in the width of the cells: the lowest of any boundary, so a safe bound.
inline constexpr double assumed_order = 1.0;

/// Factor on the error that two grids show with that order. Chosen: where the error has exactly this order,
/// the worst case, at least 90 of 100 synthetic studies contain the limit; with a factor of 1, half of them
/// (uncertainty.cpp of the unit tests). The grid convergence index has 3 for two grids, and the formal order
/// (Roache, Verification and Validation, 1998).
inline constexpr double grid_safety = 1.5;

/// Half width of a 95 % confidence interval of a mean over its standard error: quantile 0.975 of Student's
/// distribution with `freedom` degrees of freedom, at least 1; to 0.1 %, below 2 up to 9 % too large between
/// those that are tabulated. Does not throw.
[[nodiscard]] double student_factor(double freedom);

/// Half width of the 95 % confidence interval of the mean over an interval of time, from the means of
/// `batches` parts of equal duration. Correlation between neighbours, estimated to first order, widens it.
/// NaN for a series that is too short for that, with less than three independent parts, for another number of
/// means, or if one is not finite. Source: batch means (Law, Simulation Modeling and Analysis, 2015, chapter
/// 9) of an autoregressive process. Does not throw.
[[nodiscard]] double batch_half_width(std::span<const double> means);

/// The same of a statistic of any parts [from, to] of an interval of time, s. Throws what `statistic` throws.
[[nodiscard]] double batch_half_width(const std::function<double(double from, double to)>& statistic,
                                      double from, double to);

/// Results of independent runs as a distribution.
struct Distribution {
  std::size_t runs = 0;
  double mean = 0.0;
  double deviation = 0.0;              ///< standard deviation of a run; NaN for one
  double lowest = 0.0, highest = 0.0;  ///< 5 and 95 % quantiles, by linear interpolation between runs
  double half_width = 0.0;             ///< of the 95 % confidence interval of the mean
};

/// Distribution of the results of runs. `half_widths`: those of the means over time that the results are, one
/// each, or none. The interval of the mean is the wider one of that by the scatter of the runs, and of that
/// by these: runs that began too much alike scatter too little. By scatter it is that of Student, which
/// skewness widens (its first-order term in Johnson, J. Am. Stat. Assoc. 73, 1978, to both sides). NaN if
/// neither is known. Throws std::invalid_argument without results.
[[nodiscard]] Distribution distribution_of(std::vector<double> results,
                                           std::span<const double> half_widths = {});

/// A value with its 95 % error bar.
struct ErrorBar {
  double value = 0.0;
  double half_width = 0.0;  ///< root of the sum of the squares of the parts
  double sampling = 0.0;    ///< by the scatter of runs and of time
  double grid = 0.0;        ///< by the width of the cells; 0 for one grid, on which it is not known
};

/// Mean on one grid.
[[nodiscard]] ErrorBar error_bar(const Distribution& only);

/// Mean on the finer one of two grids, whose cells are narrower by the factor `ratio` > 1. The part of the
/// grid is `grid_safety` sqrt(d^2 + s^2) / (ratio^`assumed_order` - 1), where d is the difference of the
/// means and s that of its 95 % interval: a difference that scatter may hide does not count as none.
[[nodiscard]] ErrorBar error_bar(const Distribution& coarse, const Distribution& fine, double ratio);

/// A number to that many digits, "0.0123" or "10030": as by "%g", but without an exponent from 1 to 10^9.
/// Throws only std::bad_alloc.
[[nodiscard]] std::string number_text(double value, int digits);

/// "0.790 +- 0.012": a value and the half width of its interval to two digits of the latter; the value alone,
/// to four digits, if that is not finite. Throws only std::bad_alloc.
[[nodiscard]] std::string bar_text(double value, double half_width);

}  // namespace drogue::run
