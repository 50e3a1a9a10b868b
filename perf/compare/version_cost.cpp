#include "perf/compare/version_cost.hpp"

#include "perf/compare/speed.hpp"

namespace drogue::perf {

VersionCost version_cost(const std::vector<double>& version, const std::vector<double>& other) {
  const SpeedChange change = compare_speed({other}, {version});
  return {change.ratio, change.low, change.high};
}

Goal goal(const VersionCost& cost, double largest) {
  if (cost.high <= largest) return Goal::met;
  return cost.low > largest ? Goal::missed : Goal::undecided;
}

const char* name(Goal goal) {
  return goal == Goal::met ? "met" : goal == Goal::missed ? "missed" : "undecided";
}

}  // namespace drogue::perf
