#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <variant>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/poisson/axis_modes.hpp"
#include "kernels/linear/poisson/problem.hpp"
#include "kernels/linear/poisson/spectral_scaling.hpp"

namespace drogue::linear {

/// Tridiagonal systems along z of the coefficients of Poisson's equation in x and y.
template <class ExecutionSpace>
struct TridiagonalSystems {
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  int length;           ///< unknowns of a system
  std::int64_t modes;   ///< systems
  List x, y;            ///< eigenvalues, 1/m^2
  bool is_singular;     ///< whether system 0 determines its solution up to a constant only
  List inverse_pivots;  ///< of elimination upwards, as the unknowns

  /// Sum of the eigenvalues of a system.
  [[nodiscard]] KOKKOS_FUNCTION double eigenvalue(int mode) const {
    return x(mode % x.extent_int(0)) + y(mode / x.extent_int(0));
  }
};

/// Systems of unknowns of equal spacing h. That of the eigenvalues a and b is
/// -u[k-1] + (2 - h^2 (a + b)) u[k] - u[k+1] = -h^2 f[k]; at a Neumann end the diagonal is less by 1, at a
/// Dirichlet end more by 1.
template <class ExecutionSpace>
struct UniformSystems : TridiagonalSystems<ExecutionSpace> {
  double square_spacing;  ///< h^2, m^2
  double low, high;       ///< additions to the first and last entry of the diagonal

  /// Magnitude of the factor of f[k], and of the entry below the diagonal in row k.
  [[nodiscard]] KOKKOS_FUNCTION double source(int /*k*/) const { return square_spacing; }
  [[nodiscard]] KOKKOS_FUNCTION static constexpr double coupling(int /*k*/) { return 1.0; }
  /// Weight of unknown k in a mean, and the sum of all.
  [[nodiscard]] KOKKOS_FUNCTION static constexpr double weight(int /*k*/) { return 1.0; }
  [[nodiscard]] KOKKOS_FUNCTION double weights() const { return this->length; }

  /// Calls `set(k, inverse pivot)` for the rows of a system in turn.
  template <class Set>
  KOKKOS_FUNCTION void factor(int mode, const Set& set) const {
    double inverse = 0.0;
    for (int k = 0; k < this->length; ++k) {
      const double diagonal = 2.0 - square_spacing * this->eigenvalue(mode) + (k == 0 ? low : 0.0) +
                              (k + 1 == this->length ? high : 0.0);
      inverse = 1.0 / (diagonal - inverse);
      // The last unknown of a singular system is chosen as zero.
      if (this->is_singular && mode == 0 && k + 1 == this->length) inverse = 0.0;
      set(k, inverse);
    }
  }
};

/// Systems along a `StretchedAxis` of lengths w and conductances c. That of the eigenvalues a and b is
/// -c[k] u[k-1] + (c[k] + c[k+1] - w[k] (a + b)) u[k] - c[k+1] u[k+1] = -w[k] f[k].
template <class ExecutionSpace>
struct StretchedSystems : TridiagonalSystems<ExecutionSpace> {
  typename TridiagonalSystems<ExecutionSpace>::List lengths, conductances;
  double whole;  ///< sum of the lengths, m

  /// As those of `UniformSystems`.
  [[nodiscard]] KOKKOS_FUNCTION double source(int k) const { return lengths(k); }
  [[nodiscard]] KOKKOS_FUNCTION double coupling(int k) const { return conductances(k); }
  [[nodiscard]] KOKKOS_FUNCTION double weight(int k) const { return lengths(k); }
  [[nodiscard]] KOKKOS_FUNCTION double weights() const { return whole; }

  /// As that of `UniformSystems`, by sums of positive numbers: no digits of small pivots are lost. The pivot
  /// less c[k+1] is e = c[k] e' / (e' + c[k]) - w[k] (a + b), with e' that of the row before.
  template <class Set>
  KOKKOS_FUNCTION void factor(int mode, const Set& set) const {
    double ratio = 1.0;
    for (int k = 0; k < this->length; ++k) {
      const double excess = conductances(k) * ratio - lengths(k) * this->eigenvalue(mode);
      const double pivot = excess + conductances(k + 1);
      // The last unknown of a singular system, whose pivot is exact, is chosen as zero.
      const double inverse = pivot > 0.0 ? 1.0 / pivot : 0.0;
      ratio = excess * inverse;
      set(k, inverse);
    }
  }
};

/// Computes the inverse pivots of a system.
template <class Systems>
struct FactorLinesFunctor {
  Systems systems;

  KOKKOS_FUNCTION void operator()(const int mode) const {
    systems.factor(
        mode, [&](int k, double inverse) { systems.inverse_pivots(k * systems.modes + mode) = inverse; });
  }
};

/// Replaces the right-hand side of a system by its solution.
template <class Systems>
struct SolveLinesFunctor {
  /// Unknowns whose loads are under way together: the recurrence does not wait for each.
  static constexpr int batch = 20;
  Systems systems;
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
        const double eliminated = carried - systems.source(first + a) * f[a];
        line[(first + a) * systems.modes] = eliminated;
        carried = systems.coupling(first + a + 1) * (w[a] * eliminated);
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
        const double solution = w[a] * (f[a] + carried);
        line[(last - a) * systems.modes] = solution;
        carried = systems.coupling(static_cast<int>(last) - a) * solution;
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
      for (int a = 0; a < count; ++a) sum += systems.weight(first + a) * f[a];
    });
    const double mean = sum / systems.weights();
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
    const TridiagonalSystems<ExecutionSpace> systems{
        .length = problem.cells[2],
        .modes = static_cast<std::int64_t>(problem.cells[0]) * problem.cells[1],
        .x = x,
        .y = y,
        .is_singular = problem.is_singular(),
        .inverse_pivots =
            List(Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::linear::inverse_pivots"),
                 problem.size())};
    if (problem.is_stretched(2)) {
      const StretchedAxis axis = stretched_axis(problem, 2);
      _systems = StretchedSystems<ExecutionSpace>{
          systems, to_device(space, "drogue::linear::lengths", axis.lengths),
          to_device(space, "drogue::linear::conductances", axis.conductances),
          std::accumulate(axis.lengths.begin(), axis.lengths.end(), 0.0)};
    } else {
      const AxisConditions& axis = problem.axes[2];
      const auto addition = [&](EndCondition end) {
        return axis.on_faces ? 0.0 : end == EndCondition::neumann ? -1.0 : 1.0;
      };
      _systems = UniformSystems<ExecutionSpace>{systems, problem.spacing[2] * problem.spacing[2],
                                                addition(axis.low), addition(axis.high)};
    }
    std::visit(
        [&]<class Systems>(const Systems& of_axis) {
          launch("drogue::linear::factor_lines", FactorLinesFunctor<Systems>{of_axis});
        },
        _systems);
    space.fence("drogue::linear::TridiagonalLines");
  }

  /// Replaces the coefficients of right-hand sides by those of solutions. Asynchronous; neither fences nor
  /// allocates. Does not throw.
  void solve(const List& coefficients) const {
    std::visit(
        [&]<class Systems>(const Systems& systems) {
          launch("drogue::linear::solve_lines", SolveLinesFunctor<Systems>{systems, coefficients.data()});
        },
        _systems);
  }

 private:
  template <class Functor>
  void launch(const char* label, const Functor& functor) const {
    // Small blocks: a plane of coefficients has a few warps for each multiprocessor.
    device::launch_each<Kokkos::LaunchBounds<32, 1>>(_space, label, static_cast<int>(functor.systems.modes),
                                                     functor);
  }

  ExecutionSpace _space;
  std::variant<UniformSystems<ExecutionSpace>, StretchedSystems<ExecutionSpace>> _systems;
};

}  // namespace drogue::linear
