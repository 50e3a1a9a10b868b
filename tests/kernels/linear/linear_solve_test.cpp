#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "kernels/linear/positive.hpp"
#include "kernels/options/line_solve.hpp"
#include "kernels/reference/linear/tridiagonal.hpp"
#include "tests/support/backend.hpp"

// Batches of tridiagonal systems on random data against elimination with pivots in long double.

namespace drogue::linear {
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

/// Elements of both signs; the diagonal outweighs what is beside it by a hundredth at least.
PositiveSystems random_systems(int batch, int unknowns) {
  Random random;
  PositiveSystems all{batch, unknowns, {}, {}, {}};
  for (int k = 0; k < batch; ++k) {
    double before = 0.0;
    for (int i = 0; i < unknowns; ++i) {
      const double after = i + 1 < unknowns ? random.between(-3.0, 3.0) : 0.0;
      all.diagonal.push_back((std::abs(before) + std::abs(after)) * random.between(1.01, 2.0) + 0.1);
      if (i + 1 < unknowns) all.beside.push_back(after);
      all.right.push_back(random.between(-1.0, 1.0));
      before = after;
    }
  }
  return all;
}

TEST(LinearPositive, EqualsEliminationWithPivots) {
  for (const int unknowns : {1, 2, 5, 33, 128}) {
    const int batch = 37;
    const PositiveSystems all = random_systems(batch, unknowns);
    const auto solve = create_positive_solve(backend, all);
    for (int round = 0; round < 2; ++round) {
      solve->reset();
      solve->run();
    }
    const std::vector<double> got = solve->solution();
    for (int k = 0; k < batch; ++k) {
      std::vector<double> beside = row(all.beside, k, unknowns - 1), below = beside;
      below.insert(below.begin(), 0.0);
      beside.push_back(0.0);
      expect_equal(row(got, k, unknowns),
                   reference::solve_tridiagonal(below, row(all.diagonal, k, unknowns), beside,
                                                row(all.right, k, unknowns)),
                   std::to_string(unknowns) + " unknowns, system " + std::to_string(k));
    }
  }
}

TEST(LinearPositive, RefusesArraysThatAreNoSystems) {
  PositiveSystems all = random_systems(2, 4);
  all.beside.pop_back();
  EXPECT_THROW((void)create_positive_solve(backend, all), std::invalid_argument);
  EXPECT_THROW((void)create_positive_solve(backend, {}), std::invalid_argument);
}

/// What options solve with constant factors, drift to either side and with one neighbour only.
TEST(OptionsLines, EqualEliminationWithPivots) {
  Random random;
  for (const int nodes : {33, 64, 100, 128, 256}) {
    options::Lines all;
    all.nodes = nodes;
    for (int k = 0; k < 37; ++k) {
      const double sign = k % 5 == 4 ? -1.0 : 1.0, lower = sign * random.between(0.1, 100.0);
      const double upper = k % 7 == 6 ? 0.0 : sign * random.between(0.1, 100.0);
      all.lines.push_back(
          {lower, std::abs(lower + upper) + random.between(1.0, 50.0), upper, random.between(0.0, 1.0)});
      for (int i = 0; i < nodes; ++i) all.right.push_back(random.between(-1.0, 1.0));
    }
    const auto solve = create_line_solve(backend, all);
    solve->run();
    const std::vector<double> got = solve->solution();
    for (int k = 0; k < 37; ++k) {
      const options::Line& line = all.lines[static_cast<std::size_t>(k)];
      const auto n = static_cast<std::size_t>(nodes);
      std::vector<double> below(n, -line.lower), diagonal(n, line.diagonal), above(n, -line.upper);
      std::vector<double> right = row(all.right, k, nodes);
      diagonal.front() = 1.0, above.front() = 0.0, right.front() = line.edge;
      diagonal.back() = options::pivot(line);
      expect_equal(row(got, k, nodes), reference::solve_tridiagonal(below, diagonal, above, right),
                   std::to_string(nodes) + " nodes, line " + std::to_string(k));
    }
  }
}

TEST(OptionsLines, RefusesWhatIsNoBatch) {
  options::Lines all{64, {{1.0, 3.0, 1.0, 0.0}}, std::vector<double>(64, 1.0)};
  all.right.pop_back();
  EXPECT_THROW((void)create_line_solve(backend, all), std::invalid_argument);
  all = {32, {{1.0, 3.0, 1.0, 0.0}}, std::vector<double>(32, 1.0)};
  EXPECT_THROW((void)create_line_solve(backend, all), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::linear
