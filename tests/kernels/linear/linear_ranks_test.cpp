#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/linear/poisson/pencil_solver.hpp"
#include "kernels/linear/poisson/slab_solver.hpp"
#include "kernels/reference/linear/laplacian.hpp"
#include "tests/support/ranks.hpp"
#if defined(DROGUE_HAVE_HYPRE)
#include "kernels/linear/poisson/hypre_pfmg.hpp"
#endif

// Poisson solvers on several ranks against those on one.

namespace drogue::linear {
namespace {

using ExecutionSpace = DROGUE_TEST_SPACE;
using List = Kokkos::View<double*, ExecutionSpace::memory_space>;
using testing::belongs_to_first;
using testing::first_ranks;

List on_device(const std::vector<double>& values) { return to_device(ExecutionSpace(), "test", values); }

std::vector<double> on_host(const List& list) {
  std::vector<double> values(list.size());
  device::copy_out(ExecutionSpace(), values.data(), list, values.size());
  ExecutionSpace().fence();
  return values;
}

std::vector<double> random_values(std::size_t size) {
  std::mt19937 engine(7);
  std::vector<double> values(size);
  for (double& value : values) value = 2.0 * std::generate_canonical<double, 53>(engine) - 1.0;
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0.0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

class LinearRanks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (RankGroup::world().size() != 4) GTEST_SKIP() << "needs mpirun with four ranks";
  }
};

TEST_F(LinearRanks, TransposesEveryEntryToItsPlaceAndBack) {
  const ExecutionSpace space;
  for (const int ranks : {2, 3, 4}) {
    const RankGroup group = first_ranks(ranks);
    if (!belongs_to_first(ranks)) continue;
    for (const std::array<int, 3>& whole :
         {std::array<int, 3>{7, 9, 5}, {4, 4, 4}, {1, 8, 6}, {2, 13, 1}, {12, 4, 3}})
      for (std::size_t gathered = 0; gathered < 3; ++gathered)
        for (std::size_t split = 0; split < 3; ++split) {
          if (gathered == split) continue;
          std::vector<double> numbers(CellBox{{0, 0, 0}, whole}.size());
          for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
          CellBox before{{0, 0, 0}, whole};
          before.begin[gathered] = part_begin(whole[gathered], ranks, group.rank());
          before.cells[gathered] = part_size(whole[gathered], ranks, group.rank());
          const PencilTranspose<ExecutionSpace> transpose(group, before, gathered, whole[gathered], split);
          const CellBox after = transpose.after();
          EXPECT_EQ(whole[gathered], after.cells[gathered]);
          EXPECT_EQ(part_size(whole[split], ranks, group.rank()), after.cells[split]);
          const std::size_t most = std::max({before.size(), after.size(), std::size_t{1}});
          const HostBuffer<ExecutionSpace> send("send", most), receive("receive", most);
          const List from = on_device(testing::cut(numbers, whole, before)), to("to", after.size());
          transpose.forward(space, from, to, send, receive);
          EXPECT_EQ(testing::cut(numbers, whole, after), on_host(to));
          const List back("back", before.size());
          transpose.backward(space, to, back, send, receive);
          EXPECT_EQ(on_host(from), on_host(back));
        }
  }
}

struct Case {
  std::array<int, 3> cells;
  std::array<int, 3> parts;
  std::array<AxisConditions, 3> axes;
};

std::vector<Case> cases() {
  constexpr EndCondition n = EndCondition::neumann, d = EndCondition::dirichlet;
  const AxisConditions periodic, walls{false, n, n}, low{false, d, n}, high{false, n, d}, both{false, d, d};
  return {{{8, 7, 9}, {1, 2, 2}, {periodic, periodic, periodic}},
          {{5, 9, 8}, {1, 4, 1}, {walls, high, periodic}},
          {{6, 8, 13}, {1, 1, 4}, {low, walls, both}},
          {{9, 14, 1}, {1, 4, 1}, {walls, both, periodic}},
          {{10, 1, 12}, {1, 1, 4}, {periodic, periodic, high}},
          {{1, 8, 6}, {1, 2, 2}, {periodic, walls, walls}},
          {{3, 16, 4}, {1, 4, 1}, {walls, periodic, walls}},
          {{7, 6, 6}, {1, 1, 2}, {walls, walls, walls}}};
}

/// Gives each axis cells of widths that differ by a factor up to 20.
void stretch(PoissonProblem& problem) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int cells = problem.cells[axis] + (problem.axes[axis].on_inner_faces() ? 1 : 0);
    problem.widths[axis] = random_values(static_cast<std::size_t>(cells));
    for (double& width : problem.widths[axis]) width = 0.2 * std::pow(20.0, 0.5 * width);
  }
}

/// Expects `solve(problem, group, ranks, right-hand side)`, which returns the solution of a rank's cells, to
/// give the solution on one rank.
template <class Solve>
void expect_solutions_of_one_rank(double tolerance, bool stretched, const Solve& solve) {
  const ExecutionSpace space;
  for (const Case& each : cases()) {
    const int size = each.parts[1] * each.parts[2];
    const RankGroup group = first_ranks(size);
    if (!belongs_to_first(size)) continue;
    PoissonProblem problem{each.cells, {0.3, 0.2, 0.5}, each.axes};
    if (stretched) stretch(problem);
    const std::vector<double> right = random_values(CellBox{{0, 0, 0}, each.cells}.size());
    const List single("single", right.size());
    const DiagonalizationSolver<ExecutionSpace> reference(space, problem);
    reference.enqueue_solve(on_device(right), single);
    space.fence();
    const PencilRanks ranks{each.parts, {0, group.rank() % each.parts[1], group.rank() / each.parts[1]}};
    const CellBox box = box_of(ranks, each.cells);
    const std::vector<double> own = solve(problem, group, ranks, testing::cut(right, each.cells, box));
    EXPECT_LT(largest_difference(on_host(single), testing::joined(group, own, each.cells, box)), tolerance)
        << each.cells[0] << " x " << each.cells[1] << " x " << each.cells[2];
  }
}

TEST_F(LinearRanks, PencilsSolveAsOneRank) {
  for (const AxisMethod method : {AxisMethod::fourier, AxisMethod::diagonalization})
    for (const bool stretched : {false, true}) {
      if (method == AxisMethod::fourier && (stretched || !device::is_host<ExecutionSpace>)) continue;
      const auto solve_pencils = [&](const PoissonProblem& problem, const RankGroup& group,
                                     const PencilRanks& ranks, const std::vector<double>& right) {
        PencilSolver<ExecutionSpace> solver(ExecutionSpace(), problem, group, ranks, method);
        const List given = on_device(right), solution("solution", right.size());
        solver.enqueue_solve(given, solution);
        EXPECT_EQ(right, on_host(given));
        return on_host(solution);
      };
      expect_solutions_of_one_rank(1e-13, stretched, solve_pencils);
    }
}

/// An implicit step of diffusion of velocities on faces, of which a rank has those of its cells.
TEST_F(LinearRanks, PencilsDiffuseValuesOnFacesAsOneRank) {
  const ExecutionSpace space;
  constexpr EndCondition d = EndCondition::dirichlet, n = EndCondition::neumann;
  const RankGroup group = RankGroup::world();
  const List dt = on_device(std::vector<double>{0.4});
  for (const std::array<int, 3>& parts : {std::array<int, 3>{1, 2, 2}, {1, 4, 1}, {1, 1, 4}})
    for (const std::size_t component : {0U, 1U, 2U})
      for (const bool stretched : {false, true})
        for (const AxisMethod method : {AxisMethod::fourier, AxisMethod::diagonalization}) {
          if (method == AxisMethod::fourier && (stretched || !device::is_host<ExecutionSpace>)) continue;
          PoissonProblem problem{{6, 13, 14}, {0.3, 0.2, 0.5}, {}};
          for (AxisConditions& axis : problem.axes) axis = {false, d, n};
          problem.axes[component] = {false, d, d, true};
          --problem.cells[component];
          if (stretched) stretch(problem);
          const SpectralOperator implicit{dt.data(), 0.7};
          const std::vector<double> right = random_values(problem.size());
          const List single("single", right.size());
          DiagonalizationSolver<ExecutionSpace>(space, problem)
              .enqueue_solve(on_device(right), single, implicit);
          space.fence();
          const PencilRanks ranks{parts, {0, group.rank() % parts[1], group.rank() / parts[1]}};
          const CellBox box = unknowns_of(ranks, problem);
          PencilSolver<ExecutionSpace> solver(space, problem, group, ranks, method);
          const List solution("solution", box.size());
          solver.enqueue_solve(on_device(testing::cut(right, problem.cells, box)), solution, implicit);
          EXPECT_LT(largest_difference(on_host(single),
                                       testing::joined(group, on_host(solution), problem.cells, box)),
                    1e-13)
              << "component " << component << ", " << parts[1] << " x " << parts[2] << " ranks";
        }
}

/// Box of the reference with unknowns at centres.
reference::CellBox box_of_problem(const PoissonProblem& problem) {
  reference::CellBox box{problem.cells, problem.spacing, {}, problem.widths, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto end = [&](EndCondition condition) {
      if (problem.axes[axis].periodic) return reference::End::periodic;
      return condition == EndCondition::dirichlet ? reference::End::dirichlet : reference::End::neumann;
    };
    box.ends[axis] = {end(problem.axes[axis].low), end(problem.axes[axis].high)};
  }
  return box;
}

/// Difference d of two solutions of A u = f.
struct SolutionDifference {
  /// |A d| / (|A| |u|) in the norm weighted by volumes, as the backward error of a direct solver, which
  /// perturbs f and u by a few units of round-off of their norms. The error of u itself is larger by the
  /// condition of A.
  double backward;
  double mean;  ///< of d over the norm of u, if A does not see a constant
};
SolutionDifference difference_of(const PoissonProblem& problem, const std::vector<double>& u,
                                 const std::vector<double>& v) {
  const reference::CellBox box = box_of_problem(problem);
  std::vector<double> volumes, signs, difference(u.size());
  for (int k = 0; k < box.cells[2]; ++k)
    for (int j = 0; j < box.cells[1]; ++j)
      for (int i = 0; i < box.cells[0]; ++i) {
        const int index[3] = {i, j, k};
        double volume = 1.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (!box.widths[axis].empty()) volume *= box.widths[axis][static_cast<std::size_t>(index[axis])];
        volumes.push_back(volume);
        signs.push_back((i + j + k) % 2 == 0 ? 1.0 : -1.0);
      }
  for (std::size_t i = 0; i < u.size(); ++i) difference[i] = u[i] - v[i];
  const std::vector<double> residual = reference::laplacian(box, difference),
                            row_sums = reference::laplacian(box, signs);
  double squares = 0.0, of_residual = 0.0, sum = 0.0, whole = 0.0, norm_of_operator = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    squares += volumes[i] * u[i] * u[i];
    of_residual += volumes[i] * residual[i] * residual[i];
    sum += volumes[i] * difference[i];
    whole += volumes[i];
    norm_of_operator = std::max(norm_of_operator, std::abs(row_sums[i]));
  }
  const double norm = std::sqrt(squares);
  return {std::sqrt(of_residual) / (norm_of_operator * norm),
          problem.is_singular() ? std::abs(sum) / (std::sqrt(whole) * norm) : 0.0};
}

/// Boxes that slabs of unequal numbers of planes divide.
std::vector<Case> slab_cases() {
  constexpr EndCondition n = EndCondition::neumann, d = EndCondition::dirichlet;
  const AxisConditions periodic, walls{false, n, n}, high{false, n, d}, both{false, d, d};
  std::vector<Case> all;
  for (const int ranks : {1, 2, 3, 4})
    for (const AxisConditions& z : {periodic, walls, high, both})
      for (const std::array<int, 3>& cells :
           {std::array<int, 3>{8, 9, 13}, {9, 6, 31}, {1, 8, 12}, {7, 1, 17}, {1, 1, 29}}) {
        const bool has_walls = all.size() % 2 == 1;
        all.push_back({cells, {1, 1, ranks}, {has_walls ? walls : periodic, has_walls ? high : periodic, z}});
      }
  return all;
}

TEST_F(LinearRanks, SlabsSolveAsOneRank) {
  const ExecutionSpace space;
  int solves = 0;
  for (const Case& each : slab_cases()) {
    const int size = each.parts[2];
    const RankGroup group = first_ranks(size);
    if (!belongs_to_first(size)) continue;
    const DeviceCommunicator<ExecutionSpace> communicator(space, group);
    const PencilRanks ranks{each.parts, {0, 0, group.rank()}};
    const CellBox box = box_of(ranks, each.cells);
    for (const bool stretched : {false, true}) {
      PoissonProblem problem{each.cells, {0.3, 0.2, 0.5}, each.axes};
      if (stretched) stretch(problem);
      const std::vector<double> right = random_values(problem.size()),
                                own = testing::cut(right, each.cells, box);
      const List single("single", right.size());
      DiagonalizationSolver<ExecutionSpace>(space, problem).enqueue_solve(on_device(right), single);
      for (const AxisMethod method : {AxisMethod::fourier, AxisMethod::diagonalization}) {
        if (!SlabSolver<ExecutionSpace>::supports(problem, method)) continue;
        const bool in_place = ++solves % 2 == 0;
        const SlabSolver<ExecutionSpace> solver(
            space, problem, communicator, ranks, method,
            solves % 3 == 0 ? InvertedOperators::any : InvertedOperators::laplacian, in_place);
        const List given = on_device(own), solution = in_place ? given : List("solution", own.size());
        solver.enqueue_solve(given, solution);
        if (!in_place) {
          EXPECT_EQ(own, on_host(given));
        }
        const SolutionDifference found = difference_of(
            problem, on_host(single), testing::joined(group, on_host(solution), each.cells, box));
        const std::string what = std::to_string(each.cells[0]) + " x " + std::to_string(each.cells[1]) +
                                 " x " + std::to_string(each.cells[2]) + " on " + std::to_string(size);
        // Twice the bounds that `Poisson` and `StretchedPoisson` tests assert for one solver on thin grids.
        EXPECT_LT(found.backward, 6e-15) << what;
        EXPECT_LT(found.mean, 2e-13) << what;
      }
    }
  }
  EXPECT_GT(solves, 0);
}

TEST_F(LinearRanks, SlabsDiffuseValuesOnFacesAsOneRank) {
  const ExecutionSpace space;
  constexpr EndCondition d = EndCondition::dirichlet, n = EndCondition::neumann;
  const RankGroup group = RankGroup::world();
  const DeviceCommunicator<ExecutionSpace> communicator(space, group);
  const PencilRanks ranks{{1, 1, 4}, {0, 0, group.rank()}};
  for (const bool periodic : {false, true})
    for (const std::size_t component : {0U, 1U, 2U})
      for (const bool stretched : {false, true})
        for (const AxisMethod method : {AxisMethod::fourier, AxisMethod::diagonalization}) {
          PoissonProblem problem{{6, 13, 14}, {0.3, 0.2, 0.5}, {}};
          for (AxisConditions& axis : problem.axes) axis = {periodic, d, n};
          problem.axes[component] = {periodic, d, d, !periodic || stretched};
          if (!periodic) --problem.cells[component];
          if (stretched) stretch(problem);
          if (!SlabSolver<ExecutionSpace>::supports(problem, method)) continue;
          const SlabSolver<ExecutionSpace> solver(space, problem, communicator, ranks, method);
          const std::vector<double> right = random_values(problem.size());
          const CellBox box = unknowns_of(ranks, problem);
          // The operator changes from solve to solve.
          for (const double length : {0.4, 0.01, 30.0}) {
            const List dt = on_device(std::vector<double>{length});
            const SpectralOperator implicit{dt.data(), 0.7};
            const List single("single", right.size()), solution("solution", box.size());
            DiagonalizationSolver<ExecutionSpace>(space, problem)
                .enqueue_solve(on_device(right), single, implicit);
            solver.enqueue_solve(on_device(testing::cut(right, problem.cells, box)), solution, implicit);
            EXPECT_LT(largest_difference(on_host(single),
                                         testing::joined(group, on_host(solution), problem.cells, box)),
                      1e-13)
                << "component " << component << ", dt " << length;
          }
        }
}

TEST_F(LinearRanks, SlabsRejectWhatTheyCannotSolve) {
  const ExecutionSpace space;
  const RankGroup group = RankGroup::world();
  const DeviceCommunicator<ExecutionSpace> communicator(space, group);
  PoissonProblem problem{{6, 8, 16}, {0.3, 0.2, 0.5}, {}};
  const auto solver = [&](const PencilRanks& ranks, AxisMethod method) {
    return SlabSolver<ExecutionSpace>(space, problem, communicator, ranks, method,
                                      InvertedOperators::laplacian);
  };
  const PencilRanks slabs{{1, 1, 4}, {0, 0, group.rank()}};
  EXPECT_THROW(static_cast<void>(solver({{1, 4, 1}, {0, group.rank(), 0}}, AxisMethod::diagonalization)),
               std::invalid_argument);
  const SlabSolver<ExecutionSpace> laplacian = solver(slabs, AxisMethod::diagonalization);
  const List dt("dt", 1), values("values", 6 * 8 * 4), few("values", 6);
  EXPECT_THROW(laplacian.enqueue_solve(values, values, {dt.data(), 0.7}), std::invalid_argument);
  EXPECT_THROW(laplacian.enqueue_solve(few, values), std::invalid_argument);
  EXPECT_THROW(laplacian.enqueue_solve(values, few), std::invalid_argument);
  problem.widths[0].assign(6, 0.3);
  EXPECT_FALSE(SlabSolver<ExecutionSpace>::supports(problem, AxisMethod::fourier));
  EXPECT_THROW(static_cast<void>(solver(slabs, AxisMethod::fourier)), std::invalid_argument);
}

#if defined(DROGUE_HAVE_HYPRE)
TEST_F(LinearRanks, HypreSolvesAsOneRank) {
  for (const bool stretched : {false, true})
    expect_solutions_of_one_rank(1e-10, stretched,
                                 [](const PoissonProblem& problem, const RankGroup& group,
                                    const PencilRanks& ranks, const std::vector<double>& right) {
                                   HyprePfmgSolver<ExecutionSpace> solver(ExecutionSpace(), problem, group,
                                                                          ranks, 1e-13);
                                   const List solution("solution", right.size());
                                   solver.enqueue_solve(on_device(right), solution);
                                   EXPECT_TRUE(solver.converged());
                                   return on_host(solution);
                                 });
}
#endif

}  // namespace
}  // namespace drogue::linear
