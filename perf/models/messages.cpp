#include "perf/models/messages.hpp"

#include <algorithm>

namespace drogue::perf {

namespace {

/// Least number of doublings that reach `ranks`.
int doublings(int ranks) {
  int count = 0;
  while ((1 << count) < ranks) ++count;
  return count;
}

}  // namespace

int message_rounds(const std::array<int, 3>& parts) {
  const int ranks = parts[1] * parts[2];
  if (ranks == 1) return 0;
  const int solve = parts[1] == 1 ? ranks - 1 : 2 * (parts[1] - 1) + 2 * (parts[2] - 1);
  return 3 + solve + 2 * doublings(ranks);
}

Link make_link(double shortest, double exchange, double bytes) {
  // Noise may make a short message the slower one.
  constexpr double least = 1e-9;
  return {shortest, bytes / std::max(exchange - shortest, least)};
}

double message_time(const Link& link, double rounds, double bytes) {
  return rounds * link.latency + bytes / link.bandwidth;
}

StepEstimate estimate_step(const FlowMachine& machine, const std::array<int, 3>& cells, int ranks) {
  const double plane = static_cast<double>(cells[0]) * cells[1];
  const int planes = (cells[2] + ranks - 1) / ranks;  // of the largest slab
  StepEstimate step{.compute = machine.fixed_time + machine.time_per_cell * plane * planes};
  if (ranks == 1) return step;
  const Link& link = ranks > machine.ranks_per_node ? machine.between_nodes : machine.in_node;
  constexpr double bytes = 8.0;
  step.ghosts = message_time(link, 3, bytes * (2.0 * 9.0 + 2.0) * plane);
  step.gather = (ranks - 1) * message_time(link, 1, bytes * 2.0 * plane);
  step.agreement = message_time(link, 2 * doublings(ranks), 0.0);
  return step;
}

}  // namespace drogue::perf
