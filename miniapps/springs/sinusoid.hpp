#pragma once

#include <vector>

namespace drogue::springs_app {

/// Frequency (Hz) of the sinusoid about a constant that is nearest to the samples, in the sense of least
/// squares; not a number where they show less than one and a half periods. The first guess counts crossings
/// of the mean, so one mode must prevail.
double fitted_frequency(const std::vector<double>& time, const std::vector<double>& value);

/// When a sampled displacement first reaches half of its largest, between two samples by a straight line;
/// not a number where it does not move.
double half_rise_time(const std::vector<double>& time, const std::vector<double>& value);

}  // namespace drogue::springs_app
