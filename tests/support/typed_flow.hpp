#pragma once

#include <cstddef>

#include "kernels/flow/flow_solver.hpp"
#include "tests/support/flow_case.hpp"

namespace drogue::testing {

/// Flow solver on an execution space, with its instance, at the start of a random velocity.
template <class Space>
struct TypedFlow {
  TypedFlow(const flow::Parameters& p, unsigned seed) : parameters(p), domain(p), solver(instance, p) {
    const StaggeredField u = random_field(domain, seed);
    for (std::size_t c = 0; c < 3; ++c) solver.upload(static_cast<flow::StateField>(c), u[c]);
    solver.start();
  }

  /// Three arrays of the state, from that of the x component on.
  [[nodiscard]] StaggeredField arrays(flow::StateField first) {
    StaggeredField values = domain.zero_field();
    for (std::size_t c = 0; c < 3; ++c)
      solver.download(static_cast<flow::StateField>(static_cast<std::size_t>(first) + c), values[c]);
    return values;
  }
  [[nodiscard]] StaggeredField velocity() { return arrays(flow::StateField::velocity_x); }

  flow::Parameters parameters;
  FlowDomain domain;
  device::Instance<Space> instance{4};
  flow::FlowSolver<Space> solver;
};

}  // namespace drogue::testing
