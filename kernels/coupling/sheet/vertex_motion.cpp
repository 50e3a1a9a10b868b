#include "kernels/coupling/sheet/vertex_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "kernels/device/expression.hpp"
#include "kernels/stepping/motion_jet.hpp"
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
    // The nearest power of two, since another end of the run changes the first rate a little; it is infinite
    // at rest.
    const double time = std::exp2(std::round(std::log2(cfl / part.rate)));
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

/// Shortest interval by a derivative of the motion, which need not have a limit, in parts of the run.
constexpr double shortest_interval = 1e-6;
/// Derivatives that move a vertex by less than this part of its displacement within the run are round-off.
constexpr double round_off = 1e-9;

using Places = std::vector<mesh::Vector>;

/// Up to nine vertices of a motion, at rest.
Places places_of(const mesh::Mesh& mesh, const fabric::Motion& moved) {
  constexpr std::size_t most = 9;
  const std::size_t count = moved.vertices.size(), samples = std::min(count, most);
  Places places;
  for (std::size_t i = 0; i < samples; ++i)
    places.push_back(mesh.rest[static_cast<std::size_t>(
        moved.vertices[samples == 1 ? 0 : i * (count - 1) / (samples - 1)])]);
  return places;
}

std::vector<stepping::MotionInterval> resolved_displacement(const Parameters& p, const fabric::Motion& moved,
                                                            const Places& places) {
  const auto axis = static_cast<std::size_t>(moved.axis);
  const double width = (p.flow.high[axis] - p.flow.low[axis]) / p.flow.cells[axis];
  stepping::PrescribedMotion motion;
  motion.values = places.size();
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
  return stepping::motion_intervals(motion, p.flow.horizon);
}

/// Division by a derivative of the displacement: forces follow the acceleration, in which a motion that is
/// small beside another may be the largest part. Empty if it is round-off.
std::vector<stepping::MotionInterval> resolved_derivative(const Parameters& p, const fabric::Motion& moved,
                                                          const Places& places,
                                                          double stepping::MotionJet::*derivative,
                                                          double power) {
  const double end = p.flow.horizon;
  constexpr int samples = 128;
  double displacement = 0.0, largest = 0.0;
  const auto raise = [](double& value, double candidate) {
    if (std::isfinite(candidate)) value = std::max(value, std::abs(candidate));
  };
  for (const mesh::Vector& place : places)
    for (int i = 0; i <= samples; ++i) {
      const stepping::MotionJet jet = stepping::motion_jet(moved.displacement, place, end * i / samples);
      raise(displacement, jet.value);
      raise(largest, jet.*derivative);
    }
  if (!(largest * power > round_off * displacement)) return {};
  stepping::PrescribedMotion motion;
  motion.values = places.size();
  motion.evaluate = [&](double time, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = stepping::motion_jet(moved.displacement, places[i], time).*derivative;
  };
  motion.rate = [](double, std::span<const double>, std::span<const double>) { return 0.0; };
  motion.times = stepping::constants_of({&moved.displacement, 1});
  std::vector<stepping::MotionInterval> intervals = stepping::motion_intervals(motion, end);
  for (stepping::MotionInterval& interval : intervals) {
    interval.longest = std::max(interval.longest, shortest_interval * end);
    interval.begins_with = 0;
  }
  return intervals;
}

std::vector<stepping::MotionInterval> motion_of(const Parameters& p, const fabric::Motion& moved) {
  const Places places = places_of(p.fabric.mesh, moved);
  const double end = p.flow.horizon;
  std::vector<stepping::MotionInterval> intervals = resolved_displacement(p, moved, places);
  for (stepping::MotionInterval& interval : intervals) interval.longest *= share_of_interval;
  intervals = with_short_first_steps(intervals, p.flow.cfl);
  for (const auto& [derivative, power] : {std::pair{&stepping::MotionJet::rate, end},
                                          std::pair{&stepping::MotionJet::acceleration, end * end}}) {
    std::vector<stepping::MotionInterval> resolved = resolved_derivative(p, moved, places, derivative, power);
    for (stepping::MotionInterval& interval : resolved) interval.longest *= share_of_interval;
    intervals = stepping::merged(intervals, resolved);
  }
  return intervals;
}

}  // namespace

std::vector<stepping::MotionInterval> vertex_motion(const Parameters& parameters) {
  std::vector<stepping::MotionInterval> result;
  for (const fabric::Motion& moved : parameters.fabric.motions)
    if (!moved.vertices.empty()) result = stepping::merged(result, motion_of(parameters, moved));
  return result;
}

}  // namespace drogue::coupling
