#include "kernels/gas/solver.hpp"

#include <stdexcept>
#include <string>

#include "kernels/device/allocate.hpp"
#include "kernels/device/block_size.hpp"

namespace drogue::gas {

// Solvers on an execution-space instance of their own: instances/solver.cpp, for each backend.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters);
template <class ExecutionSpace>
std::unique_ptr<Solver> make_baseline_solver(const Parameters& parameters);

namespace {

void check(const Parameters& p) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("gas solver: ") + what);
  };
  require(p.cells >= 8 && p.cells <= (std::int64_t{1} << 28), "cells must lie between 8 and 2^28");
  require(p.gamma > 1.0, "gamma must exceed 1");
  require(p.x_max > p.x_min, "the domain must not be empty");
  require((p.left == Boundary::periodic) == (p.right == Boundary::periodic),
          "both ends must be periodic, or none");
  require(p.weno_power == 1 || p.weno_power == 2, "weno_power must be 1 or 2");
  require(p.fixed_dt > 0.0 || p.cfl > 0.0, "cfl must be positive");
  require(device::is_block_size(p.block), "block must be a multiple of 32 between 32 and 512");
}

}  // namespace

std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters) {
  check(parameters);
  return device::allocate([&] {
    return device::dispatch(backend,
                            [&]<class ExecutionSpace>() { return make_solver<ExecutionSpace>(parameters); });
  });
}

std::unique_ptr<Solver> create_baseline_solver(device::Backend backend, const Parameters& parameters) {
  check(parameters);
  return device::allocate([&] {
    return device::dispatch(
        backend, [&]<class ExecutionSpace>() { return make_baseline_solver<ExecutionSpace>(parameters); });
  });
}

}  // namespace drogue::gas
