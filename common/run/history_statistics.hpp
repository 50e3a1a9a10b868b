#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace drogue::run {

/// Number that is computed from the values of a column of history.csv in an interval of time.
enum class Statistic { mean, max, min, last, frequency, amplitude };

/// End of an interval of time that the end of the run bounds, s.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// Rows of a column of history.csv: times, s, which increase, and values.
struct HistoryRows {
  std::span<const double> time, value;
};

/// Rows in [from, to], s; none if the first of all is later than `from`, as in a run that continues without
/// the history before. Does not throw.
[[nodiscard]] HistoryRows rows_between(const HistoryRows& rows, double from, double to);

/// Mean by the trapezoidal rule; NaN for fewer than two rows. Does not throw.
[[nodiscard]] double mean_of(const HistoryRows& rows);

/// Mean over [from, to], s, by the trapezoidal rule, with values at both ends by linear interpolation; to the
/// last row if that is before `to`. NaN for fewer than two rows in between. Does not throw.
[[nodiscard]] double mean_between(const HistoryRows& all, double from, double to);

/// Frequency, 1/s, at which the values cross their mean upwards: between the first and the last of these
/// times, interpolated linearly. NaN for fewer than three of them: they may be those of a transient. Does not
/// throw.
[[nodiscard]] double frequency_of(const HistoryRows& rows);

/// Value at a time, s, by linear interpolation between rows, or of the last row before; NaN before the first
/// one. Does not throw.
[[nodiscard]] double value_at(const HistoryRows& rows, double time);

/// Half of the difference between the largest and the least value, each by a parabola through its row and the
/// two beside it, which adds at most what eight rows in a period of a sine may miss; NaN for fewer than two
/// rows. Does not throw.
[[nodiscard]] double amplitude_of(const HistoryRows& rows);

/// The statistic of this name in [from, to], s; the last value is that at the time `to`. The largest and the
/// least value are NaN without rows, and if a value is NaN. Does not throw.
[[nodiscard]] double statistic_of(Statistic statistic, const HistoryRows& all, double from, double to);

/// Mean number of rows in a period of a frequency, 1/s; NaN or 0 without one. Does not throw.
[[nodiscard]] double rows_in_period(const HistoryRows& rows, double frequency);

}  // namespace drogue::run
