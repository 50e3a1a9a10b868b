#pragma once

#include <vector>

namespace drogue::springs_app {

/// Frequency, Hz, of the least-squares sinusoid with offset; NaN for less than one and a half periods. The
/// first guess counts crossings of the mean, so one mode must dominate.
double fitted_frequency(const std::vector<double>& time, const std::vector<double>& value);

/// Time, s, at which a sampled displacement first reaches half of its maximum, by linear interpolation; NaN
/// without motion.
double half_rise_time(const std::vector<double>& time, const std::vector<double>& value);

}  // namespace drogue::springs_app
