#include "kernels/coupling/sheet/vertex_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "kernels/device/expression.hpp"
#include "kernels/stepping/motion_steps.hpp"

namespace drogue::coupling {
namespace {

/// The running mean of the acceleration of the air (`SheetParameters::filter`) delays it by some steps: the
/// force on a plate that moves all fluid of a channel to and fro is off by 5 percent with 100 steps a period,
/// and by 80 percent with 20.
constexpr double share_of_interval = 0.2;

/// Steps in which the fluid follows a body that moves at once: some 50.
constexpr double settling_steps = 64.0;

/// Adds short steps where motion begins: until the fluid follows, the body moves by at most `cfl` cells.
std::vector<stepping::MotionInterval> with_short_first_steps(
    const std::vector<stepping::MotionInterval>& intervals, double cfl) {
  std::vector<stepping::MotionInterval> result;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    stepping::MotionInterval part = intervals[i];
    const double time = cfl / part.rate;  // infinite at rest
    if ((i == 0 || part.begins_with != 0) && time < settling_steps * part.longest) {
      result.push_back({part.begin, time / settling_steps, part.rate, part.begins_with});
      if (i + 1 < intervals.size() && part.begin + time >= intervals[i + 1].begin) continue;
      part.begin += time;
      part.begins_with = 0;
    }
    result.push_back(part);
  }
  return result;
}

std::vector<stepping::MotionInterval> motion_of(const Parameters& p, const fabric::Motion& moved) {
  constexpr std::size_t most = 9;
  const std::size_t count = moved.vertices.size(), samples = std::min(count, most);
  std::vector<mesh::Vector> places;
  for (std::size_t i = 0; i < samples; ++i)
    places.push_back(p.fabric.mesh.rest[static_cast<std::size_t>(
        moved.vertices[samples == 1 ? 0 : i * (count - 1) / (samples - 1)])]);
  const auto axis = static_cast<std::size_t>(moved.axis);
  const double width = (p.flow.high[axis] - p.flow.low[axis]) / p.flow.cells[axis];
  stepping::PrescribedMotion motion;
  motion.values = samples;
  motion.evaluate = [&](double time, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = device::evaluate(moved.displacement, places[i][0], places[i][1], places[i][2], time);
  };
  motion.rate = [&](double dt, std::span<const double> before, std::span<const double> after) {
    double largest = 0.0;
    for (std::size_t i = 0; i < after.size() && dt > 0.0; ++i)
      largest = std::max(largest, std::abs(after[i] - before[i]) / dt);
    return p.flow.cells[axis] > 1 ? largest / width : 0.0;
  };
  motion.times = stepping::constants_of({&moved.displacement, 1});
  std::vector<stepping::MotionInterval> intervals = stepping::motion_intervals(motion, p.flow.horizon);
  for (stepping::MotionInterval& interval : intervals) interval.longest *= share_of_interval;
  return with_short_first_steps(intervals, p.flow.cfl);
}

}  // namespace

std::vector<stepping::MotionInterval> vertex_motion(const Parameters& parameters) {
  std::vector<stepping::MotionInterval> result;
  for (const fabric::Motion& moved : parameters.fabric.motions)
    if (!moved.vertices.empty()) result = stepping::merged(result, motion_of(parameters, moved));
  return result;
}

}  // namespace drogue::coupling
