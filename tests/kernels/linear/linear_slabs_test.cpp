#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/linear/poisson/slab_factor.hpp"
#include "kernels/linear/poisson/slab_substitution.hpp"
#include "kernels/reference/linear/chain.hpp"
#include "tests/support/profiled.hpp"

// Tridiagonal systems along z in slabs of one process, against a dense elimination of the whole systems.

namespace drogue::linear {
namespace {

using Space = DROGUE_TEST_SPACE;
using List = Kokkos::View<double*, Space::memory_space>;
using Lines = SlabLines<Space>;

std::vector<double> on_host(const List& list) {
  std::vector<double> values(list.size());
  device::copy_out(Space(), values.data(), list, values.size());
  Space().fence();
  return values;
}

std::vector<double> random_values(std::size_t size, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<double> values(size);
  for (double& value : values) value = 2.0 * std::generate_canonical<double, 53>(engine) - 1.0;
  return values;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::isfinite(value) ? std::max(most, std::abs(value)) : HUGE_VAL;
  return most;
}

/// First nodes of slabs of random sizes, and the end.
std::vector<int> random_slabs(int length, int slabs, unsigned seed) {
  std::vector<int> begins(static_cast<std::size_t>(length - 1));
  for (int k = 1; k < length; ++k) begins[static_cast<std::size_t>(k - 1)] = k;
  std::shuffle(begins.begin(), begins.end(), std::mt19937(seed));
  begins.resize(static_cast<std::size_t>(slabs - 1));
  begins.push_back(0);
  begins.push_back(length);
  std::ranges::sort(begins);
  return begins;
}

/// All slabs of a problem in this process.
class Slabs {
 public:
  Slabs(const PoissonProblem& problem, const std::vector<int>& begins, const PlaneModes<Space>& modes,
        const SpectralOperator& spectral_operator = {})
      : _begins(begins) {
    const int slabs = count();
    for (std::size_t slab = 0; slab + 1 < begins.size(); ++slab) {
      _lines.push_back(make_slab_lines(_space, problem, begins[slab], begins[slab + 1], modes));
      _lines.back().set_operator(spectral_operator);
    }
    for (int slab = 0; slab < slabs; ++slab)
      _separators.push_back(make_slab_separators(_space, _lines[0], slabs, slab));
    const auto ports = static_cast<std::size_t>(_lines[0].port_count());
    const List all("ports", ports * _lines.size());
    for (std::size_t slab = 0; slab < _lines.size(); ++slab)
      factor_slab(_space, _lines[slab], all.data() + slab * ports);
    for (std::size_t slab = 0; slab < _lines.size(); ++slab)
      connect_slabs(_space, _lines[slab], _separators[slab], all.data());
    _sources = List("sources", static_cast<std::size_t>(_lines[0].source_count()) * _lines.size());
    _space.fence();
  }

  [[nodiscard]] int count() const { return static_cast<int>(_begins.size()) - 1; }

  /// Replaces the right-hand sides of all nodes by the unknowns.
  void enqueue_solve(const List& values) const {
    const auto size = static_cast<std::size_t>(_lines[0].source_count());
    for (std::size_t slab = 0; slab < _lines.size(); ++slab)
      reduce_slab(_space, _lines[slab], part(values, slab), _sources.data() + slab * size);
    for (std::size_t slab = 0; slab < _lines.size(); ++slab)
      substitute_slab(_space, _lines[slab], _separators[slab], part(values, slab), _sources.data());
  }

 private:
  [[nodiscard]] List part(const List& values, std::size_t slab) const {
    const auto lines = static_cast<std::size_t>(_lines[0].lines());
    const auto begin = static_cast<std::size_t>(_begins[slab]),
               end = static_cast<std::size_t>(_begins[slab + 1]);
    return List(values.data() + begin * lines, (end - begin) * lines);
  }

  Space _space;
  std::vector<int> _begins;
  std::vector<Lines> _lines;
  std::vector<SlabSeparators<Space>> _separators;
  List _sources;
};

struct Ends {
  const char* name;
  AxisConditions axis;
};

std::vector<Ends> all_ends() {
  constexpr EndCondition n = EndCondition::neumann, d = EndCondition::dirichlet;
  return {{"periodic", {}},
          {"Neumann", {false, n, n}},
          {"Neumann below Dirichlet", {false, n, d}},
          {"Dirichlet below Neumann", {false, d, n}},
          {"Dirichlet", {false, d, d}},
          {"faces", {false, d, d, true}},
          {"periodic faces", {true, n, n, true}}};
}

/// Problem along z with more modes than a work item of a host treats; other axes of one cell stand for any.
PoissonProblem problem_along_z(int length, const AxisConditions& axis, bool stretched) {
  PoissonProblem problem{{1, 1, length}, {1.0, 1.0, 0.25}, {}};
  problem.axes[2] = axis;
  if (!stretched) return problem;
  problem.widths[2] = random_values(static_cast<std::size_t>(length + (axis.on_inner_faces() ? 1 : 0)), 3);
  for (double& width : problem.widths[2]) width = 0.2 * std::pow(20.0, 0.5 * width);
  return problem;
}

/// Chain of a mode, from the equations of the problem.
reference::Chain chain_of(const PoissonProblem& problem, double eigenvalue, double diffusivity,
                          double reaction) {
  PoissonProblem listed = problem;
  const AxisConditions& axis = problem.axes[2];
  if (listed.widths[2].empty())
    listed.widths[2].assign(static_cast<std::size_t>(problem.cells[2] + (axis.on_inner_faces() ? 1 : 0)),
                            problem.spacing[2]);
  const StretchedAxis along = stretched_axis(listed, 2);
  reference::Chain chain{
      .conductances = along.conductances, .shunts = along.lengths, .is_ring = axis.periodic, .weights = {}};
  for (double& conductance : chain.conductances) conductance *= diffusivity;
  for (double& shunt : chain.shunts) shunt *= reaction - diffusivity * eigenvalue;
  if (eigenvalue == 0.0 && reaction == 0.0 && problem.is_singular()) chain.weights = along.lengths;
  return chain;
}

/// Largest error of the unknowns of a line, relative to the largest of them, for right-hand sides f.
double largest_error(const PoissonProblem& problem, const std::vector<double>& eigenvalues,
                     const std::vector<double>& f, const std::vector<double>& u, int line, int parts,
                     double diffusivity = 1.0, double reaction = 0.0) {
  const std::size_t lines = eigenvalues.size() * static_cast<std::size_t>(parts),
                    n = static_cast<std::size_t>(problem.cells[2]), at = static_cast<std::size_t>(line);
  const double eigenvalue = eigenvalues[at / static_cast<std::size_t>(parts)];
  const std::vector<double> lengths = chain_of(problem, 0.0, 0.0, 1.0).shunts;
  std::vector<double> source(n), error(n);
  for (std::size_t k = 0; k < n; ++k)
    source[k] = (reaction > 0.0 ? 1.0 : -1.0) * lengths[k] * f[k * lines + at];
  const std::vector<double> expected =
      reference::solve_chain(chain_of(problem, eigenvalue, diffusivity, reaction), source);
  for (std::size_t k = 0; k < n; ++k) error[k] = u[k * lines + at] - expected[k];
  return largest(error) / largest(expected);
}

/// Eigenvalues of 150 modes along x: 0, some that hardly differ from it, and others up to strong decay.
std::vector<double> eigenvalues() {
  std::vector<double> values{0.0, -1e-15, -1e-12, -1e-9, -1e-6, -1e-4};
  while (values.size() < 150) values.push_back(-1e-3 * std::pow(1.15, static_cast<double>(values.size())));
  return values;
}

PlaneModes<Space> modes_of(const std::vector<double>& values) {
  return {to_device(Space(), "x", values), to_device(Space(), "y", {0.0})};
}

constexpr int checked_lines[] = {0, 1, 2, 3, 4, 5, 6, 40, 63, 64, 100, 149};

class LinearSlabs : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Widths, LinearSlabs, ::testing::Bool(),
                         [](const auto& each) { return each.param ? "Stretched" : "Equal"; });

// ctest-label: smoke
TEST_P(LinearSlabs, SolveAsOneSystemForAllEndsAndNumbersOfSlabs) {
  constexpr int length = 53;
  const std::vector<double> values = eigenvalues();
  const std::vector<double> f = random_values(values.size() * length, 1);
  for (const Ends& ends : all_ends()) {
    const PoissonProblem problem = problem_along_z(length, ends.axis, GetParam());
    std::vector<double> whole;
    for (int slabs = 1; slabs <= 16; ++slabs) {
      const Slabs solver(problem, random_slabs(length, slabs, static_cast<unsigned>(slabs)),
                         modes_of(values));
      const List list = to_device(Space(), "values", f);
      solver.enqueue_solve(list);
      const std::vector<double> u = on_host(list);
      if (slabs == 1) {
        whole = u;
        for (const int line : checked_lines)
          EXPECT_LT(largest_error(problem, values, f, u, line, 1), 1e-13) << ends.name << ", line " << line;
      }
      for (std::size_t line = 0; line < values.size(); ++line) {
        double most = 0.0, difference = 0.0;
        for (std::size_t k = line; k < u.size(); k += values.size()) {
          most = std::max(most, std::abs(whole[k]));
          difference = std::max(difference, std::abs(u[k] - whole[k]));
        }
        EXPECT_LT(difference, 1e-13 * most) << ends.name << ", " << slabs << " slabs, line " << line;
      }
    }
  }
}

TEST_P(LinearSlabs, SolveShortAndLongSystems) {
  // Of one node per slab, of whole batches, and of several with a rest.
  for (const int length : {2, 3, 21, 22, 120, 131})
    for (const Ends& ends : {all_ends()[0], all_ends()[1], all_ends()[4]}) {
      const PoissonProblem problem = problem_along_z(length, ends.axis, GetParam());
      const std::vector<double> values{0.0, -1e-10, -0.01, -1.0, -1e4};
      const std::vector<double> f = random_values(values.size() * static_cast<std::size_t>(length), 2);
      for (const int slabs : {1, 2, 3}) {
        if (slabs > length) continue;
        const Slabs solver(problem, random_slabs(length, slabs, 7), modes_of(values));
        const List list = to_device(Space(), "values", f);
        solver.enqueue_solve(list);
        for (int line = 0; line < 5; ++line)
          EXPECT_LT(largest_error(problem, values, f, on_host(list), line, 1), 1e-12)
              << ends.name << ", " << length << " nodes in " << slabs << " slabs, line " << line;
      }
    }
}

TEST_P(LinearSlabs, GiveMeanZeroWithoutShunts) {
  constexpr int length = 37;
  for (const Ends& ends : {all_ends()[0], all_ends()[1], all_ends()[6]}) {
    const PoissonProblem problem = problem_along_z(length, ends.axis, GetParam());
    const std::vector<double> lengths = chain_of(problem, 0.0, 0.0, 1.0).shunts, values{0.0, -0.5};
    for (const int slabs : {1, 2, 5, 16}) {
      const Slabs solver(problem, random_slabs(length, slabs, 5), modes_of(values));
      for (const double constant : {0.0, 1e6}) {
        std::vector<double> f = random_values(2 * length, 4);
        for (double& each : f) each += constant;
        const List list = to_device(Space(), "values", f);
        solver.enqueue_solve(list);
        const std::vector<double> u = on_host(list);
        double mean = 0.0, whole = 0.0, most = 0.0;
        for (std::size_t k = 0; k < length; ++k) {
          mean += lengths[k] * u[2 * k];
          whole += lengths[k];
          most = std::max(most, std::abs(u[2 * k]));
        }
        // The mean of u is a sum over nodes in which the constant cancels.
        EXPECT_LT(std::abs(mean), 1e-15 * length * std::max(constant, 1.0) * whole * most)
            << ends.name << ", " << slabs;
        EXPECT_LT(largest_error(problem, values, f, u, 0, 1), 1e-14 * std::max(constant, 10.0)) << ends.name;
      }
    }
  }
}

TEST_P(LinearSlabs, DiffuseImplicitly) {
  constexpr int length = 41;
  const std::vector<double> values = eigenvalues();
  const std::vector<double> f = random_values(values.size() * length, 6);
  for (const double dt : {0.0, 1e-6, 0.3, 1e7})
    for (const Ends& ends : all_ends()) {
      const PoissonProblem problem = problem_along_z(length, ends.axis, GetParam());
      const List step = to_device(Space(), "dt", {dt});
      const Slabs solver(problem, random_slabs(length, 4, 9), modes_of(values), {step.data(), 0.7});
      const List list = to_device(Space(), "values", f);
      solver.enqueue_solve(list);
      for (const int line : checked_lines)
        EXPECT_LT(largest_error(problem, values, f, on_host(list), line, 1, 0.7 * dt, 1.0), 1e-13)
            << ends.name << ", dt " << dt << ", line " << line;
    }
}

TEST(SlabLines, HaveCouplingsThatVanishInLongSlabs) {
  // Across 1500 nodes that of the largest eigenvalue would be 1e-2500.
  const PoissonProblem problem = problem_along_z(3000, {}, false);
  const std::vector<double> values{0.0, -1e-8, -30.0, -600.0};
  const Slabs solver(problem, {0, 1500, 3000}, modes_of(values)),
      single(problem, {0, 3000}, modes_of(values));
  const std::vector<double> f = random_values(values.size() * 3000, 6);
  const List two = to_device(Space(), "values", f), one = to_device(Space(), "values", f);
  solver.enqueue_solve(two);
  single.enqueue_solve(one);
  const std::vector<double> u = on_host(two), expected = on_host(one);
  std::vector<double> difference(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) difference[i] = u[i] - expected[i];
  EXPECT_LT(largest(difference), 1e-12 * largest(expected));
}

TEST(SlabLines, SolveComplexCoefficientsOnDevicesOnly) {
  const PoissonProblem problem = problem_along_z(31, {}, false);
  const std::vector<double> values{0.0, -1e-9, -0.3, -7.0};
  PlaneModes<Space> modes = modes_of(values);
  modes.parts = 2;
  modes.normalisation = 0.25;
  if (device::is_host<Space>) {
    EXPECT_THROW(Slabs(problem, {0, 31}, modes), std::invalid_argument);
    return;
  }
  std::vector<double> f = random_values(2 * values.size() * 31, 8);
  const Slabs solver(problem, {0, 9, 10, 31}, modes);
  const List list = to_device(Space(), "values", f);
  solver.enqueue_solve(list);
  for (double& each : f) each *= modes.normalisation;
  for (int line = 0; line < 8; ++line)
    EXPECT_LT(largest_error(problem, values, f, on_host(list), line, 2), 1e-13) << line;
}

TEST(SlabLines, NeitherAllocateNorFence) {
  const Slabs solver(problem_along_z(31, {}, false), {0, 9, 31}, modes_of({0.0, -1.0}));
  const List list("values", 2 * 31);
  const auto before = testing::profiled();
  solver.enqueue_solve(list);
  const auto after = testing::profiled();
  EXPECT_EQ(after.kernel_launches - before.kernel_launches, 4);
  EXPECT_EQ(after.allocations - before.allocations, 0);
  EXPECT_EQ(after.copies - before.copies, 0);
  EXPECT_EQ(after.fences - before.fences, 0);
}

TEST(SlabLines, RejectSlabsWithoutCells) {
  const PlaneModes<Space> modes = modes_of({0.0});
  const PoissonProblem problem = problem_along_z(9, {}, false);
  for (const auto& [begin, end] : {std::pair{3, 3}, {-1, 3}, {5, 10}, {4, 2}})
    EXPECT_THROW(static_cast<void>(make_slab_lines(Space(), problem, begin, end, modes)),
                 std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_slab_lines(Space(), problem_along_z(1, {}, false), 0, 1, modes)),
               std::invalid_argument);
}

}  // namespace
}  // namespace drogue::linear
