#pragma once

namespace drogue::stepping {

/// Launch strategy for the steps of a solver. Host backends run plain loops.
enum class Driver {
  automatic,   ///< `persistent` if the solver supports it for the given problem, else `graph`
  plain,       ///< kernels launched one by one
  graph,       ///< the kernels of a step as one CUDA graph
  persistent,  ///< many steps in one launch of teams that are all resident at once
  stages,      ///< `graph` with one kernel per stage, for solvers that otherwise fuse the stages of a step
};

/// Driver that runs: the requested one if it is available, otherwise the next of persistent, graph, plain.
/// Does not throw.
constexpr Driver select_driver(Driver requested, bool has_persistent, bool has_graph) {
  if (requested == Driver::stages) return requested;
  const bool wants_persistent = requested == Driver::automatic || requested == Driver::persistent;
  if (wants_persistent && has_persistent) return Driver::persistent;
  return requested == Driver::plain || !has_graph ? Driver::plain : Driver::graph;
}

/// Name of a driver in messages and result files. Does not throw.
constexpr const char* driver_name(Driver driver) {
  switch (driver) {
    case Driver::automatic:
      return "automatic";
    case Driver::plain:
      return "plain";
    case Driver::graph:
      return "graph";
    case Driver::persistent:
      return "persistent";
    case Driver::stages:
      break;
  }
  return "stages";
}

}  // namespace drogue::stepping
