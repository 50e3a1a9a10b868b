#pragma once

#include <cstddef>
#include <vector>

namespace drogue::parachute_app {

/// Number of times from `from` on, s. Times increase. Does not throw.
[[nodiscard]] std::size_t rows_from(const std::vector<double>& time, double from);

/// Mean number of rows in a period of a frequency, 1/s, from the time `from` on, s; NaN or 0 without one.
/// Does not throw.
[[nodiscard]] double rows_in_period(const std::vector<double>& time, double from, double frequency);

/// Mean of a value over the times from `from` on, s, by the trapezoidal rule; NaN for fewer than two of them.
/// Times increase. Does not throw.
[[nodiscard]] double mean_from(const std::vector<double>& time, const std::vector<double>& value,
                               double from);

/// Frequency, 1/s, at which a value crosses its mean upwards from the time `from` on, s: between the first
/// and the last of these times, interpolated linearly. NaN for fewer than three of them: they may be those
/// of a transient. Times increase. Does not throw.
[[nodiscard]] double frequency_from(const std::vector<double>& time, const std::vector<double>& value,
                                    double from);

/// Half of the difference between the largest and the least value from the time `from` on, s, each by a
/// parabola through its row and the two beside it; NaN without rows. Times increase. Does not throw.
[[nodiscard]] double amplitude_from(const std::vector<double>& time, const std::vector<double>& value,
                                    double from);

}  // namespace drogue::parachute_app
