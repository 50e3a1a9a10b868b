#pragma once

#include <cstddef>

#include "kernels/flow/flow_solver.hpp"
#include "tests/support/flow_case.hpp"

namespace drogue::testing {

/// Flow solver on an execution space, with its instance, at the start of a random velocity.
template <class Space>
struct TypedFlow {
  TypedFlow(const flow::Parameters& p, unsigned seed) : parameters(p), domain(p), solver(instance, p) {
    upload_velocity(solver, random_field(domain, seed));
    solver.start();
  }

  [[nodiscard]] StaggeredField velocity() { return testing::velocity(solver); }

  flow::Parameters parameters;
  FlowDomain domain;
  device::Instance<Space> instance{4};
  flow::FlowSolver<Space> solver;
};

}  // namespace drogue::testing
