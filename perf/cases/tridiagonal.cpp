#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "kernels/reference/linear/tridiagonal.hpp"
#include "perf/cases/cases.hpp"
#include "perf/measure/parts.hpp"
#include "perf/models/tridiagonal.hpp"
#include "perf/tridiagonal/solvers.hpp"

namespace drogue::perf {

namespace {

constexpr double tridiagonal_tolerance = 1e-14;  ///< relative to the largest unknown
constexpr int checked_systems = 64;

/// Implicit time steps of `count` options with random diffusion, drift and step size.
tridiagonal::ToeplitzBatch random_batch(int count, int nodes) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  tridiagonal::ToeplitzBatch all;
  all.nodes = nodes;
  for (int k = 0; k < count; ++k) {
    const double diffusion = between(20.0, 500.0), drift = between(-0.3, 0.3) * diffusion;
    const double rate = between(20.0, 300.0), lower = diffusion - drift, upper = diffusion + drift;
    all.systems.push_back({lower, rate + lower + upper, upper, between(0.0, 1.0)});
    for (int i = 0; i < nodes; ++i) all.right.push_back(rate * between(0.0, 1.0));
  }
  return all;
}

/// Factor s of the scaling x_i = s^i z_i that makes the matrix symmetric.
double symmetric_scale(const tridiagonal::ToeplitzSystem& system) {
  return std::sqrt(system.lower / system.upper);
}

/// The scaled systems; the boundary value of node 0 moves to the right-hand side.
tridiagonal::SpdBatch symmetric_systems(const tridiagonal::ToeplitzBatch& batch) {
  tridiagonal::SpdBatch all;
  all.batch = static_cast<int>(batch.systems.size());
  all.unknowns = batch.nodes - 1;
  const double* right = batch.right.data();
  for (const tridiagonal::ToeplitzSystem& system : batch.systems) {
    const double scale = symmetric_scale(system);
    double power = 1.0;
    for (int i = 1; i < batch.nodes; ++i) {
      power *= scale;
      const bool last = i + 1 == batch.nodes;
      all.diagonal.push_back(last ? tridiagonal::limit_pivot(system) : system.diagonal);
      if (!last) all.off_diagonal.push_back(-std::sqrt(system.lower * system.upper));
      all.right.push_back((right[i] + (i == 1 ? system.lower * system.boundary_value : 0.0)) / power);
    }
    right += batch.nodes;
  }
  return all;
}

/// Unknowns of nodes 1 .. n - 1 of system k. `solved` has n columns, or n - 1 columns of scaled unknowns.
std::vector<double> unknowns_of(const tridiagonal::ToeplitzBatch& batch, int k,
                                const std::vector<double>& solved) {
  const auto width = solved.size() / batch.systems.size(), nodes = static_cast<std::size_t>(batch.nodes);
  const auto row = solved.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * width);
  std::vector<double> x(row + static_cast<std::ptrdiff_t>(width + 1 - nodes),
                        row + static_cast<std::ptrdiff_t>(width));
  if (width == nodes) return x;
  const double scale = symmetric_scale(batch.systems[static_cast<std::size_t>(k)]);
  double power = 1.0;
  for (double& value : x) value *= power *= scale;
  return x;
}

/// Largest error of the first systems against Gaussian elimination with pivoting in long double, which is too
/// slow for all of them.
double error_of(const tridiagonal::ToeplitzBatch& batch, const std::vector<double>& solved) {
  double largest = 0.0;
  const auto n = static_cast<std::size_t>(batch.nodes);
  for (int k = 0; k < std::min(checked_systems, static_cast<int>(batch.systems.size())); ++k) {
    const tridiagonal::ToeplitzSystem& system = batch.systems[static_cast<std::size_t>(k)];
    std::vector<double> below(n, -system.lower), diagonal(n, system.diagonal), above(n, -system.upper);
    const auto first = batch.right.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * n);
    std::vector<double> right(first, first + static_cast<std::ptrdiff_t>(n));
    diagonal.front() = 1.0, above.front() = 0.0, right.front() = system.boundary_value;
    diagonal.back() = tridiagonal::limit_pivot(system);
    const std::vector<double> truth = reference::solve_tridiagonal(below, diagonal, above, right);
    const std::vector<double> x = unknowns_of(batch, k, solved);
    const double most = std::abs(*std::ranges::max_element(truth, {}, [](double v) { return std::abs(v); }));
    for (std::size_t i = 0; i < x.size(); ++i)
      largest = std::max(largest, std::abs(x[i] - truth[i + 1]) / most);
  }
  return largest;
}

Case tridiagonal_case(device::Backend backend, bool by_pttrf, int count, int nodes) {
  const std::string variant = (by_pttrf ? "pttrf/" : "scan/") + std::to_string(nodes);
  const Arithmetic work = by_pttrf ? spd_arithmetic(nodes - 1) : toeplitz_arithmetic(nodes);
  const std::int64_t bytes = by_pttrf ? spd_bytes(nodes - 1) : toeplitz_bytes(nodes);
  return {.name = "tridiagonal/" + std::string(device::name(backend)) + "/" + std::to_string(count) + "/" +
                  variant,
          .backend = backend,
          .unit_of_work = "batch",
          .bound = by_pttrf ? "memory, on a host divisions that wait for one another"
                            : "memory, on a host arithmetic",
          .tolerance = tridiagonal_tolerance,
          .prepare =
              [=] {
                const auto batch =
                    std::make_shared<const tridiagonal::ToeplitzBatch>(random_batch(count, nodes));
                const std::shared_ptr<tridiagonal::BatchSolver> solver =
                    by_pttrf ? create_spd_solver(backend, symmetric_systems(*batch))
                             : create_toeplitz_solver(backend, *batch);
                return Sample{.reset = [=] { solver->reset(); },
                              .work =
                                  [=] {
                                    solver->solve();
                                    return 1L;
                                  },
                              .error = [=] { return error_of(*batch, solver->solution()); },
                              .complete =
                                  [=](Facts& facts) {
                                    if (device::needs_device(backend))
                                      facts.device_seconds = median_of_works([&] {
                                        solver->reset();
                                        return solver->timed_solve();
                                      });
                                  }};
              },
          .facts = {.cells = count,
                    .variant = variant,
                    .flops = static_cast<double>(count * work.flops()),
                    .bytes = static_cast<double>(count * bytes)}};
}

}  // namespace

std::vector<Case> tridiagonal_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : present_backends()) {
    for (const int nodes : quick ? std::vector{64} : std::vector{128, 256})
      for (const bool by_pttrf : {true, false})
        cases.push_back(tridiagonal_case(backend, by_pttrf, quick ? 64 : 4096, nodes));
  }
  return cases;
}

}  // namespace drogue::perf
