#include "kernels/stepping/expression_steps.hpp"

#include <algorithm>
#include <limits>

#include "kernels/device/expression.hpp"
#include "kernels/stepping/motion_steps.hpp"

namespace drogue::stepping {

std::vector<MotionInterval> expression_intervals(const device::ExpressionProgram& program,
                                                 std::span<const std::array<double, 3>> places, double end) {
  constexpr std::size_t most = 9;
  const std::size_t count = places.size(), samples = std::min(count, most);
  PrescribedMotion motion;
  motion.values = samples;
  motion.evaluate = [&](double time, std::span<double> values) {
    for (std::size_t i = 0; i < samples; ++i) {
      const auto& [x, y, z] = places[samples == 1 ? 0 : i * (count - 1) / (samples - 1)];
      values[i] = device::evaluate(program, x, y, z, time);
    }
  };
  motion.rate = [](double, std::span<const double>, std::span<const double>) { return 0.0; };
  motion.times = constants_of({&program, 1});
  return samples == 0 ? std::vector<MotionInterval>{} : motion_intervals(motion, end);
}

double shortest_interval(std::span<const MotionInterval> intervals, double begin, double end) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < intervals.size() && intervals[i].begin < end; ++i)
    if (i + 1 == intervals.size() || intervals[i + 1].begin > begin)
      shortest = std::min(shortest, intervals[i].longest);
  return shortest;
}

}  // namespace drogue::stepping
