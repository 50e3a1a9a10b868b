#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/reference/linear/laplacian.hpp"
#include "tests/support/profiled.hpp"

// Direct Poisson solvers: residual by the oracle's Laplacian, agreement of both, singular problems, costs.

namespace drogue::linear {
namespace {

using Space = DROGUE_TEST_SPACE;
using Values = Kokkos::View<double*, Space::memory_space>;
using reference::End;

/// The pairs of ends of an axis.
constexpr std::array<std::array<End, 2>, 5> end_pairs{{{End::periodic, End::periodic},
                                                       {End::neumann, End::neumann},
                                                       {End::neumann, End::dirichlet},
                                                       {End::dirichlet, End::neumann},
                                                       {End::dirichlet, End::dirichlet}}};

PoissonProblem problem_of(const reference::CellBox& box) {
  PoissonProblem problem;
  problem.cells = box.cells;
  problem.spacing = box.spacing;
  const auto condition = [](End end) {
    return end == End::dirichlet ? EndCondition::dirichlet : EndCondition::neumann;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    problem.axes[axis] = {box.ends[axis][0] == End::periodic, condition(box.ends[axis][0]),
                          condition(box.ends[axis][1])};
  return problem;
}

/// A solver by diagonalization that may prepare for the Laplacian.
class LaplacianSolver : public DiagonalizationSolver<Space> {
 public:
  LaplacianSolver(const Space& space, const PoissonProblem& problem)
      : DiagonalizationSolver<Space>(space, problem, InvertedOperators::laplacian) {}
};

/// Whether a solver on this backend can treat the problem.
template <class Solver>
bool supports(const reference::CellBox& box) {
  if constexpr (std::is_same_v<Solver, FourierSolver<Space>>) return Solver::supports(problem_of(box));
  return true;
}

std::size_t size_of(const reference::CellBox& box) {
  return static_cast<std::size_t>(box.cells[0]) * static_cast<std::size_t>(box.cells[1]) *
         static_cast<std::size_t>(box.cells[2]);
}

std::vector<double> random_values(std::size_t size, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<double> values(size);
  for (double& value : values) value = 2.0 * std::generate_canonical<double, 53>(engine) - 1.0;
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::isfinite(value) ? std::max(most, std::abs(value)) : HUGE_VAL;
  return most;
}

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

/// Solution, after a check that the right-hand side is kept.
template <class Solver>
std::vector<double> solve(const reference::CellBox& box, const std::vector<double>& f) {
  const Space space;
  const Solver solver(space, problem_of(box));
  const Values rhs = to_device(space, "rhs", f), solution("solution", f.size());
  solver.enqueue_solve(rhs, solution);
  std::vector<double> result(f.size()), kept(f.size());
  device::copy_out(space, result.data(), solution, result.size());
  device::copy_out(space, kept.data(), rhs, kept.size());
  space.fence();
  EXPECT_EQ(kept, f);
  return result;
}

/// Largest residual relative to the terms of the Laplacian. A singular problem has the mean of f subtracted.
double relative_residual(const reference::CellBox& box, std::vector<double> f, const std::vector<double>& p) {
  if (problem_of(box).is_singular()) {
    const double f_mean = mean(f);
    for (double& value : f) value -= f_mean;
    EXPECT_LE(std::abs(mean(p)), 1e-13 * largest(p));
  }
  double squares = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.cells[axis] > 1) squares += 4.0 / (box.spacing[axis] * box.spacing[axis]);
  return largest(difference(reference::laplacian(box, p), f)) / (largest(f) + squares * largest(p));
}

template <class Solver>
class Poisson : public ::testing::Test {};
using Solvers = ::testing::Types<FourierSolver<Space>, DiagonalizationSolver<Space>, LaplacianSolver>;
struct SolverName {
  template <class Solver>
  static std::string GetName(int) {
    if (std::is_same_v<Solver, LaplacianSolver>) return "DiagonalizationOfTheLaplacian";
    return std::is_same_v<Solver, FourierSolver<Space>> ? "Fourier" : "Diagonalization";
  }
};
TYPED_TEST_SUITE(Poisson, Solvers, SolverName);

// ctest-label: smoke
TYPED_TEST(Poisson, ResidualIsRoundOffForAllEndConditions) {
  int solved = 0;
  for (const auto& x : end_pairs)
    for (const auto& y : end_pairs)
      for (const auto& z : end_pairs) {
        const reference::CellBox box{{6, 5, 7}, {0.3, 0.2, 0.25}, {x, y, z}};
        if (!supports<TypeParam>(box)) continue;
        const std::vector<double> f = random_values(size_of(box), 1);
        EXPECT_LT(relative_residual(box, f, solve<TypeParam>(box, f)), 1e-14) << "combination " << solved;
        ++solved;
      }
  EXPECT_GE(solved, 1);
}

TYPED_TEST(Poisson, SolvesGridsThatAreOneCellThick) {
  for (const std::array<int, 3>& cells :
       {std::array<int, 3>{9, 1, 8}, {1, 7, 6}, {8, 5, 1}, {1, 11, 1}, {1, 1, 10}, {13, 1, 1}})
    for (const auto& ends : end_pairs) {
      const reference::CellBox box{cells, {0.3, 0.2, 0.25}, {ends, ends, ends}};
      if (!supports<TypeParam>(box)) continue;
      const std::vector<double> f = random_values(size_of(box), 2);
      EXPECT_LT(relative_residual(box, f, solve<TypeParam>(box, f)), 1e-14)
          << cells[0] << " " << cells[1] << " " << cells[2];
    }
}

TYPED_TEST(Poisson, SolvesPrimeSizesAndStretchedCells) {
  for (const auto& x : {end_pairs[0], end_pairs[2]}) {
    const reference::CellBox box{
        {61, 59, 127}, {1.0, 0.1, 0.5}, {x, end_pairs[x == end_pairs[0] ? 0 : 1], end_pairs[0]}};
    if (!supports<TypeParam>(box)) continue;
    const std::vector<double> f = random_values(size_of(box), 3);
    EXPECT_LT(relative_residual(box, f, solve<TypeParam>(box, f)), 1e-13);
  }
}

TYPED_TEST(Poisson, ReturnsZeroMeanForSingularProblems) {
  const reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[0], end_pairs[0], end_pairs[0]}};
  const std::vector<double> constant(size_of(box), 3.0);
  EXPECT_LT(largest(solve<TypeParam>(box, constant)), 1e-14);
}

TYPED_TEST(Poisson, RejectsArraysOfTheWrongSize) {
  const Space space;
  const reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[0], end_pairs[0], end_pairs[0]}};
  const TypeParam solver(space, problem_of(box));
  const Values right("right", size_of(box)), wrong("wrong", size_of(box) + 1);
  EXPECT_THROW(solver.enqueue_solve(wrong, right), std::invalid_argument);
  EXPECT_THROW(solver.enqueue_solve(right, wrong), std::invalid_argument);
}

TYPED_TEST(Poisson, SolvesWithFewLaunchesAndWithoutAllocations) {
  const Space space;
  const bool is_fourier = std::is_same_v<TypeParam, FourierSolver<Space>>;
  const std::array<End, 2>& z = is_fourier ? end_pairs[0] : end_pairs[2];
  const reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[0], end_pairs[0], z}};
  const TypeParam solver(space, problem_of(box));
  const Values rhs("rhs", size_of(box)), solution("solution", size_of(box));
  solver.enqueue_solve(rhs, solution);
  space.fence();
  const auto before = testing::profiled();
  solver.enqueue_solve(rhs, solution);
  const auto after = testing::profiled();
  // Launches of Kokkos; cuFFT and cuBLAS launch kernels of their own. Three transforms each way and the
  // scaling, or two each way and the systems along z.
  const int on_host = std::is_same_v<TypeParam, LaplacianSolver> ? 5 : 7;
  EXPECT_LE(after.kernel_launches - before.kernel_launches, device::is_host<Space> ? on_host : 1);
  EXPECT_EQ(after.allocations - before.allocations, 0);
  EXPECT_EQ(after.copies - before.copies, 0);
  EXPECT_EQ(after.fences - before.fences, 0);
}

TYPED_TEST(Poisson, InvertsTheOperatorOfImplicitDiffusion) {
  constexpr double diffusivity = 0.7, dt = 0.3;
  const Space space;
  for (const auto& x : end_pairs)
    for (const auto& y : end_pairs) {
      const reference::CellBox box{{6, 5, 7}, {0.3, 0.2, 0.25}, {x, y, y}};
      if (!supports<TypeParam>(box) || std::is_same_v<TypeParam, LaplacianSolver>) continue;
      const std::vector<double> expected = random_values(size_of(box), 7);
      std::vector<double> f = reference::laplacian(box, expected);
      for (std::size_t i = 0; i < f.size(); ++i) f[i] = expected[i] - diffusivity * dt * f[i];
      const TypeParam solver(space, problem_of(box));
      const Values step = to_device(space, "step", {dt});
      const Values rhs = to_device(space, "rhs", f), solution("solution", f.size());
      solver.enqueue_solve(rhs, solution, {step.data(), diffusivity});
      std::vector<double> result(f.size());
      device::copy_out(space, result.data(), solution, result.size());
      space.fence();
      EXPECT_LT(largest(difference(result, expected)), 1e-13);
    }
}

/// Conditions of unknowns on the inner faces of an axis.
constexpr AxisConditions on_faces{false, EndCondition::dirichlet, EndCondition::dirichlet, true};

TYPED_TEST(Poisson, SolvesForUnknownsOnFaces) {
  // A line of n unknowns with zeros at both ends is one period of 2 (n + 1) odd values.
  const Space space;
  for (const int n : {1, 2, 5, 12}) {
    PoissonProblem problem;
    problem.cells = {n, 1, 3};
    problem.spacing = {0.3, 1.0, 0.2};
    problem.axes[0] = on_faces;
    problem.axes[2] = {false, EndCondition::neumann, EndCondition::neumann, false};
    if constexpr (std::is_same_v<TypeParam, FourierSolver<Space>>)
      if (!TypeParam::supports(problem)) return;
    const std::vector<double> f = random_values(problem.size(), 8);
    const TypeParam solver(space, problem);
    const Values rhs = to_device(space, "rhs", f), solution("solution", f.size());
    solver.enqueue_solve(rhs, solution);
    std::vector<double> half(f.size());
    device::copy_out(space, half.data(), solution, half.size());
    space.fence();
    const int period = 2 * (n + 1);
    const reference::CellBox box{{period, 1, 3}, {0.3, 1.0, 0.2}, {end_pairs[0], end_pairs[0], end_pairs[1]}};
    const auto odd = [&](const std::vector<double>& values) {
      std::vector<double> all(size_of(box), 0.0);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < n; ++i) {
          const double value = values[static_cast<std::size_t>(k * n + i)];
          all[static_cast<std::size_t>(k * period + 1 + i)] = value;
          all[static_cast<std::size_t>(k * period + period - 1 - i)] = -value;
        }
      return all;
    };
    EXPECT_LT(largest(difference(reference::laplacian(box, odd(half)), odd(f))), 1e-12) << n;
  }
}

TEST(PoissonSolvers, RejectOperatorsThatTheyWereNotMadeFor) {
  const Space space;
  const reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[1], end_pairs[1], end_pairs[2]}};
  const LaplacianSolver solver(space, problem_of(box));
  const Values rhs("rhs", size_of(box)), solution("solution", size_of(box)), step("step", 1);
  EXPECT_THROW(solver.enqueue_solve(rhs, solution, {step.data(), 1.0}), std::invalid_argument);
}

TEST(PoissonSolvers, FourierAndDiagonalizationAgree) {
  for (const auto& x : end_pairs)
    for (const auto& y : end_pairs) {
      const reference::CellBox box{{16, 12, 10}, {0.1, 0.2, 0.15}, {x, y, end_pairs[0]}};
      if (!supports<FourierSolver<Space>>(box)) continue;
      const std::vector<double> f = random_values(size_of(box), 5);
      const std::vector<double> fourier = solve<FourierSolver<Space>>(box, f);
      EXPECT_LT(largest(difference(fourier, solve<DiagonalizationSolver<Space>>(box, f))),
                1e-13 * largest(fourier));
    }
}

TEST(PoissonSolvers, ReproduceBitsOfRepeatedSolves) {
  const reference::CellBox box{{16, 12, 10}, {0.1, 0.2, 0.15}, {end_pairs[0], end_pairs[0], end_pairs[0]}};
  const std::vector<double> f = random_values(size_of(box), 6);
  EXPECT_EQ(solve<FourierSolver<Space>>(box, f), solve<FourierSolver<Space>>(box, f));
  EXPECT_EQ(solve<DiagonalizationSolver<Space>>(box, f), solve<DiagonalizationSolver<Space>>(box, f));
}

TEST(AxisBasis, EigenvectorsAreOrthonormalAndSatisfyTheEigenvalueEquation) {
  for (const auto& ends : end_pairs)
    for (const int n : {2, 3, 8, 13}) {
      const reference::CellBox box{{n, 1, 1}, {0.3, 1.0, 1.0}, {ends, ends, ends}};
      const AxisConditions axis = problem_of(box).axes[0];
      for (int k = 0; k < n; ++k) {
        std::vector<double> vector;
        for (int i = 0; i < n; ++i) vector.push_back(axis_eigenvector(axis, n, k, i));
        std::vector<double> image = reference::laplacian(box, vector);
        for (int i = 0; i < n; ++i)
          EXPECT_NEAR(image[static_cast<std::size_t>(i)],
                      axis_eigenvalue(axis, n, 0.3, k) * vector[static_cast<std::size_t>(i)], 1e-12);
        for (int other = 0; other < n; ++other) {
          double product = 0.0;
          for (int i = 0; i < n; ++i)
            product += vector[static_cast<std::size_t>(i)] * axis_eigenvector(axis, n, other, i);
          EXPECT_NEAR(product, k == other ? 1.0 : 0.0, 1e-14);
        }
      }
    }
}

}  // namespace
}  // namespace drogue::linear
