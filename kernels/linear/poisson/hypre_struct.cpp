#include "kernels/linear/poisson/hypre_struct.hpp"

#if defined(DROGUE_HAVE_HYPRE)

#include <HYPRE.h>
#include <HYPRE_struct_ls.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/linear/poisson/axis_modes.hpp"

namespace drogue::linear {

namespace {

void check(HYPRE_Int error) {
  if (error == 0) return;
  char text[256] = {};
  HYPRE_DescribeError(error, text);
  HYPRE_ClearAllErrors();
  throw std::runtime_error(std::string("hypre: ") + text);
}

/// hypre, from the first solver to the last.
struct Library {
  Library() { HYPRE_Init(); }
  ~Library() { HYPRE_Finalize(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

std::shared_ptr<Library> library() {
  static std::weak_ptr<Library> present;
  std::shared_ptr<Library> shared = present.lock();
  if (!shared) present = shared = std::make_shared<Library>();
  return shared;
}

/// Second difference along an axis as `stretched_axis`; lengths of 1 if all are equal, or there is one.
StretchedAxis scaled_axis(const PoissonProblem& problem, std::size_t axis) {
  if (problem.is_stretched(axis)) return stretched_axis(problem, axis);
  const auto n = static_cast<std::size_t>(problem.cells[axis]);
  const double coefficient = n == 1 ? 0.0 : 1.0 / (problem.spacing[axis] * problem.spacing[axis]);
  StretchedAxis result{.lengths = std::vector<double>(n, 1.0),
                       .conductances = std::vector<double>(n + 1, coefficient)};
  const AxisConditions& conditions = problem.axes[axis];
  if (conditions.periodic) return result;
  // The face of a Dirichlet end is half a cell away.
  result.conductances.front() = conditions.low == EndCondition::dirichlet ? 2.0 * coefficient : 0.0;
  result.conductances.back() = conditions.high == EndCondition::dirichlet ? 2.0 * coefficient : 0.0;
  return result;
}

}  // namespace

struct HypreStructSolver::Objects {
  RankGroup group;
  MPI_Comm communicator;  ///< made first: its handle initialises MPI
  std::shared_ptr<Library> hypre = library();
  HYPRE_StructGrid grid = nullptr;
  HYPRE_StructStencil stencil = nullptr;
  HYPRE_StructMatrix matrix = nullptr;
  HYPRE_StructVector right_hand_side = nullptr, solution = nullptr;
  HYPRE_StructSolver pcg = nullptr, pfmg = nullptr;
  HYPRE_Int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  std::vector<double> values;
  std::array<StretchedAxis, 3> axes;
  std::vector<double> volumes;  ///< of the cells of this rank, in units of those of equal widths
  double whole_volume = 1.0;    ///< of all ranks
  bool singular = false;
  double tolerance = 0.0;
  int max_iterations = 0;
  int iterations = 0;
  double residual = 0.0;

  explicit Objects(const RankGroup& ranks) : group(ranks), communicator(MPI_Comm_f2c(group.handle())) {}
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;
  ~Objects() {
    if (pcg != nullptr) HYPRE_StructPCGDestroy(pcg);
    if (pfmg != nullptr) HYPRE_StructPFMGDestroy(pfmg);
    if (solution != nullptr) HYPRE_StructVectorDestroy(solution);
    if (right_hand_side != nullptr) HYPRE_StructVectorDestroy(right_hand_side);
    if (matrix != nullptr) HYPRE_StructMatrixDestroy(matrix);
    if (stencil != nullptr) HYPRE_StructStencilDestroy(stencil);
    if (grid != nullptr) HYPRE_StructGridDestroy(grid);
  }

  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i)
          visit(std::array{static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                           static_cast<std::size_t>(k)});
  }
  void make_matrix(const PoissonProblem& problem);
  void subtract_mean_source();
  void subtract_mean();
  [[nodiscard]] double norm_of_values() const;
  void iterate(double relative);
  [[nodiscard]] double true_residual(const std::vector<double>& right, const std::vector<double>& x);
  void set(HYPRE_StructVector vector, const std::vector<double>& from);
  void make_vector(HYPRE_StructVector& vector);
  void make_solver(bool stretched);
};

/// Minus the Laplacian, which is positive, with each row multiplied by the volume of its cell, so that the
/// matrix is symmetric. All of the seven entries that PFMG expects; those along an axis with one cell are
/// zero.
void HypreStructSolver::Objects::make_matrix(const PoissonProblem& problem) {
  HYPRE_Int periods[3] = {0, 0, 0};
  std::vector<std::array<HYPRE_Int, 3>> offsets{{0, 0, 0}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (problem.cells[axis] > 1 && problem.axes[axis].periodic) periods[axis] = problem.cells[axis];
    for (const HYPRE_Int step : {-1, 1}) {
      offsets.push_back({0, 0, 0});
      offsets.back()[axis] = step;
    }
  }
  check(HYPRE_StructGridCreate(communicator, 3, &grid));
  check(HYPRE_StructGridSetExtents(grid, low, high));
  check(HYPRE_StructGridSetPeriodic(grid, periods));
  check(HYPRE_StructGridAssemble(grid));
  check(HYPRE_StructStencilCreate(3, static_cast<HYPRE_Int>(offsets.size()), &stencil));
  for (std::size_t entry = 0; entry < offsets.size(); ++entry)
    check(HYPRE_StructStencilSetElement(stencil, static_cast<HYPRE_Int>(entry), offsets[entry].data()));
  check(HYPRE_StructMatrixCreate(communicator, grid, stencil, &matrix));
  check(HYPRE_StructMatrixInitialize(matrix));

  std::vector<double> entries;
  for_each_cell([&](const std::array<std::size_t, 3>& cell) {
    const std::size_t diagonal = entries.size();
    entries.push_back(0.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t second = (axis + 1) % 3, third = (axis + 2) % 3;
      const double area = axes[second].lengths[cell[second]] * axes[third].lengths[cell[third]];
      for (const std::size_t upper : {0U, 1U}) {
        const std::size_t face = cell[axis] + upper;
        const double coefficient = axes[axis].conductances[face] * area;
        const bool is_end = face == 0 || face == axes[axis].lengths.size();
        entries[diagonal] += coefficient;
        entries.push_back(is_end && periods[axis] == 0 ? 0.0 : -coefficient);
      }
    }
  });
  std::vector<HYPRE_Int> numbers(offsets.size());
  for (std::size_t entry = 0; entry < numbers.size(); ++entry) numbers[entry] = static_cast<HYPRE_Int>(entry);
  check(HYPRE_StructMatrixSetBoxValues(matrix, low, high, static_cast<HYPRE_Int>(numbers.size()),
                                       numbers.data(), entries.data()));
  check(HYPRE_StructMatrixAssemble(matrix));
}

/// Makes the sum of values that are multiplied by volumes zero.
void HypreStructSolver::Objects::subtract_mean_source() {
  double sum = 0.0;
  for (const double value : values) sum += value;
  group.sum({&sum, 1});
  const double mean = sum / whole_volume;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= volumes[i] * mean;
}

/// Makes the mean of values, weighted by volumes, zero.
void HypreStructSolver::Objects::subtract_mean() {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += volumes[i] * values[i];
  group.sum({&sum, 1});
  const double mean = sum / whole_volume;
  for (double& value : values) value -= mean;
}

double HypreStructSolver::Objects::norm_of_values() const {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  group.sum({&sum, 1});
  return std::sqrt(sum);
}

/// Iterates to a recursive residual of `relative` times the norm of the right-hand side. `values` receive the
/// solution, on a singular problem without its mean; the next call begins from zero unless it is set.
void HypreStructSolver::Objects::iterate(double relative) {
  check(HYPRE_StructPCGSetTol(pcg, relative));
  // On a singular problem the preconditioner adds constants, which end the iteration early: it goes on
  // without them.
  double reached = 0.0;
  do {
    check(HYPRE_StructPCGSetMaxIter(pcg, max_iterations - iterations));
    const HYPRE_Int error = HYPRE_StructPCGSolve(pcg, matrix, right_hand_side, solution);
    if (HYPRE_CheckError(error, HYPRE_ERROR_CONV) != 0)
      HYPRE_ClearAllErrors();
    else
      check(error);
    HYPRE_Int taken = 0;
    check(HYPRE_StructPCGGetNumIterations(pcg, &taken));
    check(HYPRE_StructPCGGetFinalRelativeResidualNorm(pcg, &reached));
    check(HYPRE_StructVectorGetBoxValues(solution, low, high, values.data()));
    iterations += taken > 0 ? taken : 1;
    if (singular) {
      subtract_mean();
      set(solution, values);
    }
  } while (singular && reached > relative && iterations < max_iterations);
}

/// Norm of `right` minus the operator times `x`. `values` receive that difference, and the vector of the
/// solution zeros.
double HypreStructSolver::Objects::true_residual(const std::vector<double>& right,
                                                 const std::vector<double>& x) {
  set(right_hand_side, right);
  set(solution, x);
  check(HYPRE_StructMatrixMatvec(-1.0, matrix, solution, 1.0, right_hand_side));
  check(HYPRE_StructVectorGetBoxValues(right_hand_side, low, high, values.data()));
  check(HYPRE_StructVectorSetConstantValues(solution, 0.0));
  return norm_of_values();
}

void HypreStructSolver::Objects::set(HYPRE_StructVector vector, const std::vector<double>& from) {
  check(HYPRE_StructVectorSetBoxValues(vector, low, high, const_cast<double*>(from.data())));
  check(HYPRE_StructVectorAssemble(vector));
}

void HypreStructSolver::Objects::make_vector(HYPRE_StructVector& vector) {
  check(HYPRE_StructVectorCreate(communicator, grid, &vector));
  check(HYPRE_StructVectorInitialize(vector));
  check(HYPRE_StructVectorSetBoxValues(vector, low, high, values.data()));
  check(HYPRE_StructVectorAssemble(vector));
}

void HypreStructSolver::Objects::make_solver(bool stretched) {
  check(HYPRE_StructPFMGCreate(communicator, &pfmg));
  check(HYPRE_StructPFMGSetMaxIter(pfmg, 1));
  check(HYPRE_StructPFMGSetTol(pfmg, 0.0));
  check(HYPRE_StructPFMGSetZeroGuess(pfmg));
  // Weighted Jacobi: conjugate gradients need a symmetric preconditioner, and periodic axes with an odd
  // number of cells have no red-black order.
  check(HYPRE_StructPFMGSetRelaxType(pfmg, 1));
  // Operators of seven points on coarse grids keep the signs of the entries. With Galerkin's, conjugate
  // gradients broke down on periodic axes of 6 and 31 stretched cells.
  if (stretched) check(HYPRE_StructPFMGSetRAPType(pfmg, 1));
  check(HYPRE_StructPFMGSetNumPreRelax(pfmg, 1));
  check(HYPRE_StructPFMGSetNumPostRelax(pfmg, 1));
  check(HYPRE_StructPCGCreate(communicator, &pcg));
  check(HYPRE_StructPCGSetTol(pcg, tolerance));
  check(HYPRE_StructPCGSetTwoNorm(pcg, 1));
  check(HYPRE_StructPCGSetPrecond(pcg, HYPRE_StructPFMGSolve, HYPRE_StructPFMGSetup, pfmg));
  check(HYPRE_StructPCGSetup(pcg, matrix, right_hand_side, solution));
}

HypreStructSolver::HypreStructSolver(const PoissonProblem& problem, const RankGroup& group,
                                     const CellBox& box, double tolerance, int max_iterations)
    : _objects(std::make_unique<Objects>(group)) {
  Objects& o = *_objects;
  o.singular = problem.is_singular();
  o.tolerance = tolerance;
  o.max_iterations = max_iterations;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    o.low[axis] = box.begin[axis];
    o.high[axis] = box.begin[axis] + box.cells[axis] - 1;
    o.axes[axis] = scaled_axis(problem, axis);
    const std::vector<double>& lengths = o.axes[axis].lengths;
    o.whole_volume *= std::accumulate(lengths.begin(), lengths.end(), 0.0);
  }
  o.for_each_cell([&](const std::array<std::size_t, 3>& cell) {
    o.volumes.push_back(o.axes[0].lengths[cell[0]] * o.axes[1].lengths[cell[1]] * o.axes[2].lengths[cell[2]]);
  });
  o.values.assign(box.size(), 0.0);
  o.make_matrix(problem);
  o.make_vector(o.right_hand_side);
  o.make_vector(o.solution);
  o.make_solver(problem.is_stretched());
}

HypreStructSolver::~HypreStructSolver() = default;

void HypreStructSolver::solve(const double* right_hand_side, double* solution) {
  Objects& o = *_objects;
  for (std::size_t i = 0; i < o.values.size(); ++i) o.values[i] = -o.volumes[i] * right_hand_side[i];
  if (o.singular) o.subtract_mean_source();
  double sum = 0.0;
  for (const double value : o.values) sum += std::abs(value);
  o.group.sum({&sum, 1});
  if (!(sum > 0.0) || std::isinf(sum)) {
    // hypre divides by the norm of the right-hand side, and iterates on values that are not finite.
    const double result = sum == 0.0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < o.values.size(); ++i) solution[i] = result;
    o.iterations = 0;
    o.residual = result;
    return;
  }
  const double norm = o.norm_of_values();
  const std::vector<double> given = o.values;
  std::vector<double> sum_of_corrections(o.values.size(), 0.0);
  o.iterations = 0;
  o.residual = std::numeric_limits<double>::infinity();
  double before = 0.0;
  // The iterations end by a recursive residual, which falls below the true one: on a singular problem the
  // preconditioner adds constants, whose rounding it does not contain. Corrections for the true residual
  // follow as long as it falls.
  do {
    before = o.residual;
    o.set(o.right_hand_side, o.values);
    o.iterate(std::isinf(before) ? o.tolerance : std::min(0.5 * o.tolerance / before, 0.1));
    for (std::size_t i = 0; i < o.values.size(); ++i) sum_of_corrections[i] += o.values[i];
    o.residual = o.true_residual(given, sum_of_corrections) / norm;
    if (o.singular) o.subtract_mean_source();
  } while (o.residual > o.tolerance && o.residual < 0.9 * before && o.iterations < o.max_iterations);
  o.set(o.solution, sum_of_corrections);  // where the next solve begins
  std::ranges::copy(sum_of_corrections, solution);
}

void HypreStructSolver::set_guess(const double* guess) {
  Objects& o = *_objects;
  for (std::size_t i = 0; i < o.values.size(); ++i) o.values[i] = guess != nullptr ? guess[i] : 0.0;
  o.set(o.solution, o.values);
}

int HypreStructSolver::iterations() const { return _objects->iterations; }
double HypreStructSolver::residual() const { return _objects->residual; }
bool HypreStructSolver::converged() const { return _objects->residual <= _objects->tolerance; }

}  // namespace drogue::linear

#endif
