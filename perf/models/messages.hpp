#pragma once

#include <array>

// Model of the messages between ranks that share a flow: latency, and bytes over bandwidth (Hockney 1994).

namespace drogue::perf {

/// Connection of a rank with the others.
struct Link {
  double latency;    ///< s per round of messages
  double bandwidth;  ///< bytes/s that a rank sends
};

/// Connection with the measured times of an exchange of a number with both neighbours, and of one in which a
/// rank sends `bytes`, s. Does not throw.
[[nodiscard]] Link make_link(double shortest, double exchange, double bytes);

/// Rounds of messages of a step of one projection that wait for one another, of ranks that divide y and z
/// into `parts`: ghost cells and two single layers; around a ring the gather of slabs, or both ways the
/// transpositions along each divided axis; twice, by a tree, what the ranks agree on. Does not throw.
[[nodiscard]] int message_rounds(const std::array<int, 3>& parts);

/// Time of messages in rounds, s. Does not throw.
[[nodiscard]] double message_time(const Link& link, double rounds, double bytes);

/// A machine on which flows are extrapolated.
struct FlowMachine {
  double fixed_time;     ///< of a step on one rank, s
  double time_per_cell;  ///< of a step, s
  Link in_node, between_nodes;
  int ranks_per_node;
};

/// Fewest planes of a rank, as in `flow::find_division`.
inline constexpr int least_planes = 3;

/// Parts of the time of a step, s.
struct StepEstimate {
  double compute = 0.0, ghosts = 0.0, gather = 0.0, agreement = 0.0;

  /// Their sum: messages do not overlap with computation. Does not throw.
  [[nodiscard]] double total() const { return compute + ghosts + gather + agreement; }
};

/// Estimate for a flow that ranks divide into slabs along z. On several nodes all messages take the link
/// between them, since each round waits for its slowest message. Does not throw.
[[nodiscard]] StepEstimate estimate_step(const FlowMachine& machine, const std::array<int, 3>& cells,
                                         int ranks);

}  // namespace drogue::perf
