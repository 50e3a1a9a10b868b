#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/symmetric_eigenpairs.hpp"
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
                          condition(box.ends[axis][1]), box.on_faces[axis]};
  problem.widths = box.widths;
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

/// Widths of n cells: random ones of a ratio up to 20.
std::vector<double> random_widths(int n, unsigned seed) {
  std::vector<double> widths = random_values(static_cast<std::size_t>(n), seed);
  for (double& width : widths) width = 0.05 * std::pow(20.0, 0.5 * (width + 1.0));
  return widths;
}

/// Widths that grow by a factor from cell to cell, from the middle outwards.
std::vector<double> growing_widths(int n, double growth) {
  std::vector<double> widths;
  for (int i = 0; i < n; ++i) widths.push_back(0.1 * std::pow(growth, std::abs(i - n / 2)));
  return widths;
}

/// Length of the control volume of a value along an axis, m.
double length_along(const reference::CellBox& box, std::size_t axis, int value) {
  const std::vector<double>& widths = box.widths[axis];
  const auto i = static_cast<std::size_t>(value);
  if (widths.empty()) return 1.0;
  if (!box.on_faces[axis]) return widths[i];
  if (box.ends[axis][0] != End::periodic) return 0.5 * (widths[i] + widths[i + 1]);
  return 0.5 * (widths[i] + (i == 0 ? widths.back() : widths[i - 1]));
}

/// Control volumes of all values, relative to their mean.
std::vector<double> relative_volumes(const reference::CellBox& box) {
  std::vector<double> volumes;
  for (int k = 0; k < box.cells[2]; ++k)
    for (int j = 0; j < box.cells[1]; ++j)
      for (int i = 0; i < box.cells[0]; ++i)
        volumes.push_back(length_along(box, 0, i) * length_along(box, 1, j) * length_along(box, 2, k));
  const double average = mean(volumes);
  for (double& volume : volumes) volume /= average;
  return volumes;
}

double weighted_mean(const std::vector<double>& volumes, const std::vector<double>& values) {
  return std::inner_product(volumes.begin(), volumes.end(), values.begin(), 0.0) /
         static_cast<double>(values.size());
}

double weighted_norm(const std::vector<double>& volumes, std::vector<double> values) {
  for (double& value : values) value *= value;
  return std::sqrt(weighted_mean(volumes, values));
}

/// Largest row sum of the magnitudes of the Laplacian's entries: its values at 1, -1, 1, ... .
double operator_norm(const reference::CellBox& box) {
  std::vector<double> signs;
  for (int k = 0; k < box.cells[2]; ++k)
    for (int j = 0; j < box.cells[1]; ++j)
      for (int i = 0; i < box.cells[0]; ++i) signs.push_back((i + j + k) % 2 == 0 ? 1.0 : -1.0);
  return largest(reference::laplacian(box, signs));
}

/// Backward error of a solution p of A p = f: |A p - f| / (|A| |p|), in the norm weighted by volumes. There
/// the transforms are orthogonal: a product with n terms perturbs its argument by at most n epsilon of its
/// norm, and A p = f is solved but for a few such perturbations of f = A p and of p.
double backward_error(const reference::CellBox& box, std::vector<double> f, const std::vector<double>& p) {
  const std::vector<double> volumes = relative_volumes(box);
  if (problem_of(box).is_singular()) {
    const double f_mean = weighted_mean(volumes, f);
    for (double& value : f) value -= f_mean;
    EXPECT_LE(std::abs(weighted_mean(volumes, p)), 1e-13 * weighted_norm(volumes, p));
  }
  return weighted_norm(volumes, difference(reference::laplacian(box, p), f)) /
         (operator_norm(box) * weighted_norm(volumes, p));
}

template <class Solver>
class StretchedPoisson : public ::testing::Test {};
using StretchedSolvers = ::testing::Types<DiagonalizationSolver<Space>, LaplacianSolver>;
TYPED_TEST_SUITE(StretchedPoisson, StretchedSolvers, SolverName);

TYPED_TEST(StretchedPoisson, BackwardErrorIsRoundOffForAllEndConditions) {
  unsigned seed = 0;
  for (const auto& x : end_pairs)
    for (const auto& y : end_pairs)
      for (const auto& z : end_pairs) {
        reference::CellBox box{{6, 5, 7}, {0.3, 0.2, 0.25}, {x, y, z}};
        // One axis after the other has cells of equal widths, and at last none.
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (axis != seed % 4) box.widths[axis] = random_widths(box.cells[axis], ++seed);
        const std::vector<double> f = random_values(size_of(box), 1);
        EXPECT_LT(backward_error(box, f, solve<TypeParam>(box, f)), 1e-15) << "seed " << seed;
      }
}

TYPED_TEST(StretchedPoisson, BackwardErrorIsRoundOffForUnknownsOnFaces) {
  for (const auto& x : {end_pairs[0], end_pairs[4]})
    for (const auto& z : {end_pairs[0], end_pairs[4]})
      for (const int n : {1, 2, 5, 12}) {
        reference::CellBox box{{n, 4, n + 1}, {1.0, 1.0, 1.0}, {x, end_pairs[1], z}, {}, {true, false, true}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const bool one_more = box.on_faces[axis] && box.ends[axis][0] != End::periodic;
          box.widths[axis] = random_widths(box.cells[axis] + (one_more ? 1 : 0), 11);
        }
        const std::vector<double> f = random_values(size_of(box), 8);
        EXPECT_LT(backward_error(box, f, solve<TypeParam>(box, f)), 1e-15) << n;
      }
}

TYPED_TEST(StretchedPoisson, BackwardErrorIsRoundOffForThinGridsAndPrimeSizes) {
  for (const std::array<int, 3>& cells :
       {std::array<int, 3>{9, 1, 8}, {1, 7, 2}, {2, 5, 1}, {1, 1, 10}, {13, 1, 1}, {31, 61, 59}})
    for (const auto& ends : end_pairs) {
      reference::CellBox box{cells, {1.0, 1.0, 1.0}, {ends, end_pairs[1], ends}};
      for (std::size_t axis = 0; axis < 3; ++axis) box.widths[axis] = growing_widths(cells[axis], 1.1);
      const std::vector<double> f = random_values(size_of(box), 2);
      EXPECT_LT(backward_error(box, f, solve<TypeParam>(box, f)), 3e-15)
          << cells[0] << " " << cells[1] << " " << cells[2];
    }
}

TYPED_TEST(StretchedPoisson, SolvesNearlySingularProblems) {
  // The only end with a value is beside a cell 10^6 times as wide as the narrowest: the smallest eigenvalue
  // is 10^-13 of the largest.
  reference::CellBox box{{12, 5, 9}, {1.0, 1.0, 1.0}, {end_pairs[1], end_pairs[0], end_pairs[2]}};
  for (std::size_t axis = 0; axis < 3; ++axis) box.widths[axis] = random_widths(box.cells[axis], 4);
  box.widths[2].back() = 5e4;
  const std::vector<double> f = random_values(size_of(box), 3);
  EXPECT_LT(backward_error(box, f, solve<TypeParam>(box, f)), 1e-15);
}

TYPED_TEST(StretchedPoisson, ReturnsZeroForAConstantSource) {
  reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[0], end_pairs[1], end_pairs[1]}};
  for (std::size_t axis = 0; axis < 3; ++axis) box.widths[axis] = random_widths(box.cells[axis], 5);
  EXPECT_LT(largest(solve<TypeParam>(box, std::vector<double>(size_of(box), 3.0))), 1e-13);
}

TYPED_TEST(StretchedPoisson, ConvergesAtSecondOrderOnSmoothGrids) {
  // cos(2 pi x) between Neumann ends, sin(pi y) between Dirichlet ends, and a wave along z.
  const double pi = std::numbers::pi;
  std::vector<double> logs, log_errors;
  for (const int n : {8, 16, 32, 64}) {
    reference::CellBox box{{n, n, n}, {}, {end_pairs[1], end_pairs[4], end_pairs[0]}};
    const auto face = [&](double i) { return i / n + 0.12 * std::sin(2.0 * pi * i / n + 0.4); };
    std::vector<double> centres;
    for (int i = 0; i < n; ++i) {
      box.widths[0].push_back(face(i + 1) - face(i));
      centres.push_back(0.5 * (face(i) + face(i + 1)) - face(0));
    }
    box.widths[1] = box.widths[2] = box.widths[0];
    std::vector<double> exact, f;
    for (const double z : centres)
      for (const double y : centres)
        for (const double x : centres) {
          exact.push_back(std::cos(2.0 * pi * x) * std::sin(pi * y) * std::sin(2.0 * pi * z + 1.0));
          f.push_back(-9.0 * pi * pi * exact.back());
        }
    const std::vector<double> error = difference(solve<TypeParam>(box, f), exact);
    logs.push_back(std::log(n));
    log_errors.push_back(std::log(weighted_norm(relative_volumes(box), error)));
  }
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    products += (logs[i] - mean(logs)) * log_errors[i];
    squares += (logs[i] - mean(logs)) * (logs[i] - mean(logs));
  }
  EXPECT_NEAR(-products / squares, 2.0, 0.02);
  EXPECT_LT(std::exp(log_errors.back()), 1e-3);
}

TYPED_TEST(StretchedPoisson, AgreesWithEqualWidthsThatAreNotListed) {
  for (const auto& x : end_pairs)
    for (const auto& z : end_pairs) {
      const reference::CellBox uniform{{6, 8, 7}, {0.3, 0.2, 0.25}, {x, x, z}};
      reference::CellBox listed = uniform;
      for (std::size_t axis = 0; axis < 3; ++axis)
        listed.widths[axis].assign(static_cast<std::size_t>(uniform.cells[axis]), uniform.spacing[axis]);
      const std::vector<double> f = random_values(size_of(uniform), 6), p = solve<TypeParam>(uniform, f);
      EXPECT_LT(largest(difference(solve<TypeParam>(listed, f), p)), 1e-13 * largest(p));
    }
}

TYPED_TEST(StretchedPoisson, LaunchesNoMoreThanForEqualWidths) {
  const Space space;
  reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[0], end_pairs[0], end_pairs[2]}};
  const auto launches = [&] {
    const TypeParam solver(space, problem_of(box));
    const Values rhs("rhs", size_of(box)), solution("solution", size_of(box));
    const auto before = testing::profiled();
    solver.enqueue_solve(rhs, solution);
    const auto after = testing::profiled();
    EXPECT_EQ(after.allocations - before.allocations, 0);
    EXPECT_EQ(after.copies - before.copies, 0);
    EXPECT_EQ(after.fences - before.fences, 0);
    return after.kernel_launches - before.kernel_launches;
  };
  const auto uniform = launches();
  for (std::size_t axis = 0; axis < 3; ++axis) box.widths[axis] = random_widths(box.cells[axis], 7);
  EXPECT_EQ(launches(), uniform);
}

TYPED_TEST(StretchedPoisson, RejectsWidthsThatAreWrong) {
  const Space space;
  const reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[1], end_pairs[0], end_pairs[2]}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(box.cells[axis]);
    for (std::vector<double> widths : {std::vector<double>(n + 1, 1.0), std::vector<double>(n - 1, 1.0)}) {
      PoissonProblem problem = problem_of(box);
      problem.widths[axis] = widths;
      EXPECT_THROW(TypeParam(space, problem), std::invalid_argument);
    }
    for (const double wrong : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
      PoissonProblem problem = problem_of(box);
      problem.widths[axis].assign(n, 1.0);
      problem.widths[axis][n / 2] = wrong;
      EXPECT_THROW(TypeParam(space, problem), std::invalid_argument) << wrong;
    }
  }
}

TEST(PoissonSolvers, DiffuseImplicitlyOnStretchedGrids) {
  const Space space;
  constexpr double diffusivity = 0.7;
  for (const double dt : {1e-4, 0.3, 1e8})
    for (const auto& x : end_pairs)
      for (const bool at_faces : {false, true}) {
        reference::CellBox box{
            {6, 5, 7}, {}, {x, end_pairs[0], end_pairs[4]}, {}, {false, at_faces, at_faces}};
        for (std::size_t axis = 0; axis < 3; ++axis)
          box.widths[axis] = random_widths(box.cells[axis] + (axis == 2 && at_faces ? 1 : 0), 9);
        const std::vector<double> expected = random_values(size_of(box), 7);
        std::vector<double> f = reference::laplacian(box, expected);
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = expected[i] - diffusivity * dt * f[i];
        const DiagonalizationSolver<Space> solver(space, problem_of(box));
        const Values step = to_device(space, "step", {dt});
        const Values rhs = to_device(space, "rhs", f), solution("solution", f.size());
        solver.enqueue_solve(rhs, solution, {step.data(), diffusivity});
        std::vector<double> result(f.size());
        device::copy_out(space, result.data(), solution, result.size());
        space.fence();
        EXPECT_LT(largest(difference(result, expected)), 1e-12) << dt;
      }
}

TEST(PoissonSolvers, DoNotTransformStretchedGrids) {
  reference::CellBox box{{8, 6, 5}, {0.5, 0.5, 0.5}, {end_pairs[0], end_pairs[0], end_pairs[0]}};
  box.widths[1] = random_widths(6, 1);
  EXPECT_FALSE(FourierSolver<Space>::supports(problem_of(box)));
  EXPECT_THROW(FourierSolver<Space>(Space(), problem_of(box)), std::invalid_argument);
}

TEST(SymmetricEigenpairs, AreOrthonormalAndSatisfyTheEquationToRoundOff) {
  for (const std::size_t n : {1U, 2U, 3U, 8U, 61U})
    for (const bool sparse : {false, true}) {
      // A matrix with many equal entries and zeros has equal eigenvalues.
      std::vector<double> matrix = random_values(n * n, 3);
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i <= j; ++i)
          matrix[j * n + i] = matrix[i * n + j] =
              sparse ? std::trunc(1.3 * matrix[i * n + j]) : matrix[i * n + j];
      const Eigenpairs pairs = symmetric_eigenpairs(matrix);
      EXPECT_TRUE(std::ranges::is_sorted(pairs.values));
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < n; ++i) {
          double image = 0.0, product = 0.0;
          for (std::size_t j = 0; j < n; ++j) {
            image += matrix[j * n + i] * pairs.vectors[k * n + j];
            product += pairs.vectors[i * n + j] * pairs.vectors[k * n + j];
          }
          EXPECT_NEAR(image, pairs.values[k] * pairs.vectors[k * n + i], 1e-14 * static_cast<double>(n));
          EXPECT_NEAR(product, i == k ? 1.0 : 0.0, 2e-14);
        }
    }
  EXPECT_THROW(static_cast<void>(symmetric_eigenpairs({1.0, NAN, NAN, 1.0})), std::runtime_error);
}

TEST(AxisModes, KeepTheDigitsOfSmallEigenvalues) {
  // The largest is 10^4 times the smallest.
  constexpr int n = 200;
  for (const auto& ends : end_pairs) {
    reference::CellBox box{{n, 1, 1}, {0.3, 1.0, 1.0}, {ends, ends, ends}};
    box.widths[0].assign(n, 0.3);
    const PoissonProblem problem = problem_of(box);
    const AxisModes modes = axis_modes(problem, 0);
    std::vector<double> expected;
    for (int k = 0; k < n; ++k) expected.push_back(axis_eigenvalue(problem.axes[0], n, 0.3, k));
    std::ranges::sort(expected, std::greater<>());
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_NEAR(modes.eigenvalues[k], expected[k], -2e-13 * expected[k]) << k;
  }
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
