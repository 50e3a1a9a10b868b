// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "kernels/reference/linear/tridiagonal.hpp"
#include "perf/tridiagonal/solvers.hpp"
#include "tests/support/backend.hpp"

// Batches of random tridiagonal systems against Gaussian elimination with pivoting in long double.

namespace drogue::perf::tridiagonal {
namespace {

constexpr const auto& backend = testing::tested_backend;

class Random {
 public:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(_bits() >> 11U) * 0x1p-53;
  }

 private:
  std::mt19937_64 _bits{20};
};

/// Row k of (batch, width).
std::vector<double> row(const std::vector<double>& rows, int k, int width) {
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(k) * width;
  return {begin, begin + width};
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

void expect_equal(const std::vector<double>& got, const std::vector<double>& truth, const std::string& what) {
  ASSERT_EQ(got.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i)
    ASSERT_NEAR(got[i], truth[i], 1e-13 * largest(truth)) << what << ", unknown " << i;
}

/// Off-diagonal elements of both signs; each diagonal element exceeds the sum of their magnitudes by at least
/// 1 %.
SpdBatch random_systems(int batch, int unknowns) {
  Random random;
  SpdBatch all{batch, unknowns, {}, {}, {}};
  for (int k = 0; k < batch; ++k) {
    double before = 0.0;
    for (int i = 0; i < unknowns; ++i) {
      const double after = i + 1 < unknowns ? random.between(-3.0, 3.0) : 0.0;
      all.diagonal.push_back((std::abs(before) + std::abs(after)) * random.between(1.01, 2.0) + 0.1);
      if (i + 1 < unknowns) all.off_diagonal.push_back(after);
      all.right.push_back(random.between(-1.0, 1.0));
      before = after;
    }
  }
  return all;
}

// ctest-label: smoke
TEST(SpdSolver, EqualsEliminationWithPivoting) {
  for (const int unknowns : {1, 2, 5, 33, 128}) {
    const int batch = 37;
    const SpdBatch all = random_systems(batch, unknowns);
    const auto solver = create_spd_solver(backend, all);
    for (int round = 0; round < 2; ++round) {
      solver->reset();
      solver->solve();
    }
    const std::vector<double> got = solver->solution();
    for (int k = 0; k < batch; ++k) {
      std::vector<double> above = row(all.off_diagonal, k, unknowns - 1), below = above;
      below.insert(below.begin(), 0.0);
      above.push_back(0.0);
      expect_equal(row(got, k, unknowns),
                   reference::solve_tridiagonal(below, row(all.diagonal, k, unknowns), above,
                                                row(all.right, k, unknowns)),
                   std::to_string(unknowns) + " unknowns, system " + std::to_string(k));
    }
  }
}

TEST(BatchSolver, SolvesOnADeviceBetweenItsEvents) {
  const ToeplitzBatch systems{64, {{1.0, 3.0, 1.0, 0.5}}, std::vector<double>(64, 1.0)};
  const auto toeplitz = create_toeplitz_solver(backend, systems);
  const auto spd = create_spd_solver(backend, random_systems(1, 64));
  for (BatchSolver* const solver : {toeplitz.get(), spd.get()}) {
    solver->reset();
    const std::vector<double> before = solver->solution();
    const double seconds = solver->timed_solve();
    // No event times a host, so nothing is solved.
    EXPECT_EQ(seconds > 0.0, device::needs_device(backend));
    EXPECT_EQ(solver->solution() != before, device::needs_device(backend));
  }
}

TEST(SpdSolver, RejectsArraysOfTheWrongSize) {
  SpdBatch all = random_systems(2, 4);
  all.off_diagonal.pop_back();
  EXPECT_THROW((void)create_spd_solver(backend, all), std::invalid_argument);
  EXPECT_THROW((void)create_spd_solver(backend, {}), std::invalid_argument);
}

// Convection of either sign, and systems that couple to one neighbour only.
TEST(ToeplitzSolver, EqualsEliminationWithPivoting) {
  Random random;
  for (const int nodes : {33, 64, 100, 128, 256}) {
    ToeplitzBatch all;
    all.nodes = nodes;
    for (int k = 0; k < 37; ++k) {
      const double sign = k % 5 == 4 ? -1.0 : 1.0, lower = sign * random.between(0.1, 100.0);
      const double upper = k % 7 == 6 ? 0.0 : sign * random.between(0.1, 100.0);
      all.systems.push_back(
          {lower, std::abs(lower + upper) + random.between(1.0, 50.0), upper, random.between(0.0, 1.0)});
      for (int i = 0; i < nodes; ++i) all.right.push_back(random.between(-1.0, 1.0));
    }
    const auto solver = create_toeplitz_solver(backend, all);
    solver->solve();
    const std::vector<double> got = solver->solution();
    for (int k = 0; k < 37; ++k) {
      const ToeplitzSystem& system = all.systems[static_cast<std::size_t>(k)];
      const auto n = static_cast<std::size_t>(nodes);
      std::vector<double> below(n, -system.lower), diagonal(n, system.diagonal), above(n, -system.upper);
      std::vector<double> right = row(all.right, k, nodes);
      diagonal.front() = 1.0, above.front() = 0.0, right.front() = system.boundary_value;
      diagonal.back() = limit_pivot(system);
      expect_equal(row(got, k, nodes), reference::solve_tridiagonal(below, diagonal, above, right),
                   std::to_string(nodes) + " nodes, system " + std::to_string(k));
    }
  }
}

TEST(ToeplitzSolver, RejectsRightHandSidesAndGridsOfTheWrongSize) {
  ToeplitzBatch all{64, {{1.0, 3.0, 1.0, 0.0}}, std::vector<double>(64, 1.0)};
  all.right.pop_back();
  EXPECT_THROW((void)create_toeplitz_solver(backend, all), std::invalid_argument);
  all = {32, {{1.0, 3.0, 1.0, 0.0}}, std::vector<double>(32, 1.0)};
  EXPECT_THROW((void)create_toeplitz_solver(backend, all), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::perf::tridiagonal
