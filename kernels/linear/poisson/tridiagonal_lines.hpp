#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/poisson/problem.hpp"
#include "kernels/linear/poisson/spectral_scaling.hpp"

namespace drogue::linear {

/// Tridiagonal systems along z of the coefficients of Poisson's equation in x and y. That of the eigenvalues
/// a and b is -u[k-1] + (2 - h^2 (a + b)) u[k] - u[k+1] = -h^2 f[k], with h the spacing along z; at a Neumann
/// end the diagonal is less by 1, at a Dirichlet end more by 1.
template <class ExecutionSpace>
struct TridiagonalSystems {
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  int length;             ///< unknowns of a system
  std::int64_t modes;     ///< systems
  double square_spacing;  ///< h^2, m^2
  List x, y;              ///< eigenvalues, 1/m^2
  double low, high;       ///< additions to the first and last entry of the diagonal
  bool is_singular;       ///< whether system 0 determines its solution up to a constant only
  List inverse_pivots;    ///< of elimination upwards, as the unknowns

  /// Entry k of the diagonal of a system.
  [[nodiscard]] KOKKOS_FUNCTION double diagonal(int mode, int k) const {
    const double eigenvalue = x(mode % x.extent_int(0)) + y(mode / x.extent_int(0));
    return 2.0 - square_spacing * eigenvalue + (k == 0 ? low : 0.0) + (k + 1 == length ? high : 0.0);
  }
};

/// Computes the inverse pivots of a system.
template <class ExecutionSpace>
struct FactorLinesFunctor {
  TridiagonalSystems<ExecutionSpace> systems;

  KOKKOS_FUNCTION void operator()(const int mode) const {
    double inverse = 0.0;
    for (int k = 0; k < systems.length; ++k) {
      inverse = 1.0 / (systems.diagonal(mode, k) - inverse);
      // The last unknown of a singular system is chosen as zero.
      if (systems.is_singular && mode == 0 && k + 1 == systems.length) inverse = 0.0;
      systems.inverse_pivots(k * systems.modes + mode) = inverse;
    }
  }
};

/// Replaces the right-hand side of a system by its solution.
template <class ExecutionSpace>
struct SolveLinesFunctor {
  /// Unknowns whose loads are under way together: the recurrence does not wait for each.
  static constexpr int batch = 20;
  TridiagonalSystems<ExecutionSpace> systems;
  double* values;

  KOKKOS_FUNCTION void operator()(const int mode) const {
    const bool is_singular = systems.is_singular && mode == 0;
    if (is_singular) subtract_mean();
    double* line = values + mode;
    const double* inverse_pivot = systems.inverse_pivots.data() + mode;
    double carried = 0.0;
    for_batches([&](int first, int count) {
      double f[batch], w[batch];
      for (int a = 0; a < count; ++a) {
        f[a] = line[(first + a) * systems.modes];
        w[a] = inverse_pivot[(first + a) * systems.modes];
      }
      for (int a = 0; a < count; ++a) {
        const double eliminated = carried - systems.square_spacing * f[a];
        line[(first + a) * systems.modes] = eliminated;
        carried = w[a] * eliminated;
      }
    });
    carried = 0.0;
    for_batches([&](int first, int count) {
      double f[batch], w[batch];
      const std::int64_t last = systems.length - 1 - first;
      for (int a = 0; a < count; ++a) {
        f[a] = line[(last - a) * systems.modes];
        w[a] = inverse_pivot[(last - a) * systems.modes];
      }
      for (int a = 0; a < count; ++a) {
        carried = w[a] * (f[a] + carried);
        line[(last - a) * systems.modes] = carried;
      }
    });
    if (is_singular) subtract_mean();
  }

 private:
  /// Calls `body(first, count)` for batches of unknowns, with a constant count but for the last unknowns.
  template <class Body>
  KOKKOS_FUNCTION void for_batches(const Body& body) const {
    int first = 0;
    for (; first + batch <= systems.length; first += batch) body(first, batch);
    for (; first < systems.length; ++first) body(first, 1);
  }

  KOKKOS_FUNCTION void subtract_mean() const {
    double sum = 0.0;
    for_batches([&](int first, int count) {
      double f[batch];
      for (int a = 0; a < count; ++a) f[a] = values[(first + a) * systems.modes];
      for (int a = 0; a < count; ++a) sum += f[a];
    });
    const double mean = sum / systems.length;
    for_batches([&](int first, int count) {
      double f[batch];
      for (int a = 0; a < count; ++a) f[a] = values[(first + a) * systems.modes] - mean;
      for (int a = 0; a < count; ++a) values[(first + a) * systems.modes] = f[a];
    });
  }
};

/// Solver of Poisson's equation along z for coefficients in x and y, by elimination with pivots that are
/// computed once (Buzbee, Golub and Nielson 1970, section 2): it reads and writes an array once and the
/// pivots once each way, where products with a matrix of eigenvectors read and write it twice and multiply it
/// by n_z twice.
template <class ExecutionSpace>
class TridiagonalLines {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Whether z has ends. Does not throw.
  static bool supports(const PoissonProblem& problem) {
    return problem.varies_along(2) && !problem.axes[2].periodic;
  }

  /// Computes the pivots, one number per unknown of the problem; `x` and `y` are the eigenvalues of the
  /// coefficients, 1/m^2. Blocks. Throws std::invalid_argument for an unsupported problem and
  /// std::runtime_error if memory runs out.
  TridiagonalLines(const ExecutionSpace& space, const PoissonProblem& problem, const List& x, const List& y)
      : _space(space) {
    if (!supports(problem)) throw std::invalid_argument("tridiagonal systems along z need ends");
    const AxisConditions& axis = problem.axes[2];
    const auto addition = [&](EndCondition end) {
      return axis.on_faces ? 0.0 : end == EndCondition::neumann ? -1.0 : 1.0;
    };
    _systems = {.length = problem.cells[2],
                .modes = static_cast<std::int64_t>(problem.cells[0]) * problem.cells[1],
                .square_spacing = problem.spacing[2] * problem.spacing[2],
                .x = x,
                .y = y,
                .low = addition(axis.low),
                .high = addition(axis.high),
                .is_singular = problem.is_singular(),
                .inverse_pivots = List(
                    Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::linear::inverse_pivots"),
                    problem.size())};
    launch("drogue::linear::factor_lines", FactorLinesFunctor<ExecutionSpace>{_systems});
    space.fence("drogue::linear::TridiagonalLines");
  }

  /// Replaces the coefficients of right-hand sides by those of solutions. Asynchronous; neither fences nor
  /// allocates. Does not throw.
  void solve(const List& coefficients) const {
    launch("drogue::linear::solve_lines", SolveLinesFunctor<ExecutionSpace>{_systems, coefficients.data()});
  }

 private:
  template <class Functor>
  void launch(const char* label, const Functor& functor) const {
    // Small blocks: a plane of coefficients has a few warps for each multiprocessor.
    device::launch_each<Kokkos::LaunchBounds<32, 1>>(_space, label, static_cast<int>(_systems.modes),
                                                     functor);
  }

  ExecutionSpace _space;
  TridiagonalSystems<ExecutionSpace> _systems;
};

}  // namespace drogue::linear
