#pragma once

#include <string_view>
#include <vector>

#include "kernels/flow/solver.hpp"

namespace drogue::testing {

/// Array of the state.
inline std::vector<double> download(flow::Solver& solver, std::string_view name) {
  std::vector<double> values;
  for (const stepping::StateArray& array : solver.state())
    if (array.name == name) values.resize(array.size());
  solver.download(name, values);
  return values;
}

/// Sets all values of an array of the state.
inline void fill(flow::Solver& solver, std::string_view name, double value) {
  solver.upload(name, std::vector<double>(download(solver, name).size(), value));
}

/// Copies all arrays of the state.
inline void copy_state(flow::Solver& from, flow::Solver& to) {
  for (const stepping::StateArray& array : from.state()) to.upload(array.name, download(from, array.name));
}

}  // namespace drogue::testing
