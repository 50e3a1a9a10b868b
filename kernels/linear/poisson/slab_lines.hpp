#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"
#include "kernels/linear/poisson/axis_modes.hpp"
#include "kernels/linear/poisson/problem.hpp"
#include "kernels/linear/poisson/spectral_scaling.hpp"

// Tridiagonal systems along z that are divided into slabs: the partition method (Wang 1981), with one
// separator per slab.
//
// A system is a chain of nodes with the unknowns u. Neighbours are connected by conductances c, node k is
// connected to zero by a shunt s[k] >= 0, and q[k] is its source:
//
//     -c[k] u[k-1] + (c[k] + c[k+1] + s[k]) u[k] - c[k+1] u[k+1] = q[k] .
//
// The first node of a slab is its separator. Elimination of the others, its interior, leaves a conductance
// from the separator to that of the next slab, and a shunt and a source at both: a slab sends two numbers per
// line in a solve. Rows of the inverse of the reduced system, a chain of separators or a ring if z is
// periodic, give the unknowns at both separators, and substitution those between them.
//
// All that is computed once are sums, products and quotients of numbers that are not negative. Its relative
// errors are therefore small whatever the shunts are, and elimination without pivoting is stable (Alfa, Xue
// and Ye 2002). Without any shunt, u is determined up to a constant: the mean of the source, weighted by the
// lengths of the nodes, is then subtracted, and u has the mean zero.

namespace drogue::linear {

/// Coefficients of (reaction - diffusivity lap) u = source f.
struct LineEquation {
  double diffusivity, reaction, source;
};

/// Systems of a slab: those of modes with the eigenvalues e of the Laplacian in x and y. With the lengths w
/// and the reciprocal distances c of a `StretchedAxis`, the conductances are diffusivity c, the shunts w
/// (reaction - diffusivity e), and the sources w source f.
///
/// A mode has `parts` lines, with the same system and different f. Values of a node of all lines are
/// contiguous.
template <class ExecutionSpace>
struct SlabLines {
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  /// Nodes whose loads are under way together: the recurrences do not wait for each. With more, the registers
  /// of a device do not suffice for all loads of a batch.
  static constexpr int batch = 8;

  int length;            ///< nodes of a line in the slab, the separator first
  int parts;             ///< 1, or on a device 2: real and imaginary parts
  List x, y;             ///< eigenvalues, 1/m^2
  List lengths;          ///< m: `length`
  List conductances;     ///< 1/m: `length` + 1, below each node and above the last; not used: the first
  double low_end;        ///< 1/m, of the separator to an end of z with the value zero
  bool has_high_end;     ///< whether an end with the value zero follows the last node, and not a slab
  double normalisation;  ///< factor of all sources
  bool has_constant;     ///< whether a constant has no Laplacian
  double whole;          ///< sum of the lengths of all slabs, m
  bool is_singular;      ///< whether mode 0 has no shunts in any slab: the Laplacian of `has_constant`
  /// Laplacian, or an operator of implicit diffusion. Its dt is read in each call.
  SpectralOperator spectral_operator;

  List inverse_pivots;  ///< of the interior: (`length` - 1) * modes
  List couplings;       ///< conductance from the separator to the first node of each batch: batches * modes
  List uniform;         ///< eliminated source of these nodes in mode 0, if the source is w and it is singular

  /// Changes the operator; `factor_slab` must follow. Does not throw.
  void set_operator(const SpectralOperator& changed) {
    spectral_operator = changed;
    is_singular = has_constant && changed.dt == nullptr;
  }

  /// Numbers of systems, of lines, and of batches in the interior. Do not throw.
  [[nodiscard]] KOKKOS_FUNCTION int modes() const { return x.extent_int(0) * y.extent_int(0); }
  [[nodiscard]] KOKKOS_FUNCTION int lines() const { return modes() * parts; }
  [[nodiscard]] KOKKOS_FUNCTION int batches() const { return (length + batch - 2) / batch; }
  /// Number of lines of mode 0 if it is singular. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION int singular_lines() const { return is_singular ? parts : 0; }
  /// Numbers that a slab sends when it is factored, and in a solve. Do not throw.
  [[nodiscard]] KOKKOS_FUNCTION int port_count() const { return 3 * modes() + (is_singular ? 3 : 0); }
  [[nodiscard]] KOKKOS_FUNCTION int source_count() const { return 2 * lines() + singular_lines(); }

  /// Coefficients of the equation. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION LineEquation equation() const {
    const double* dt = spectral_operator.dt;
    if (dt == nullptr) return {1.0, 0.0, -normalisation};
    return {spectral_operator.diffusivity * *dt, 1.0, normalisation};
  }
  /// Place of a mode, or of a line, in lists of them for several nodes or slabs. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t at(int row, int mode) const {
    return static_cast<std::int64_t>(row) * modes() + mode;
  }
  /// Conductance to the separator of the node after one with the given conductance. Without subnormal
  /// numbers, which are slow on hosts. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION static double next_coupling(double coupling, double factor) {
    const double next = coupling * factor;
    return next > 1e-280 ? next : 0.0;
  }
};

/// Place of a slab among all, in the order along z, and its rows of the inverses of the reduced systems.
template <class ExecutionSpace>
struct SlabSeparators {
  using List = typename SlabLines<ExecutionSpace>::List;
  int slabs, slab;   ///< number, and this one
  List low, high;    ///< rows of the own separator and the next one: slabs * modes
  List work, means;  ///< slabs * modes, and slabs: used by `connect_slabs`
};

/// List that is not initialised. Throws std::runtime_error if memory runs out.
template <class ExecutionSpace>
typename SlabLines<ExecutionSpace>::List allocate_list(const ExecutionSpace& space, const std::string& label,
                                                       std::int64_t size) {
  return typename SlabLines<ExecutionSpace>::List(
      Kokkos::view_alloc(space, Kokkos::WithoutInitializing, label), static_cast<std::size_t>(size));
}

/// Modes of the coefficients of an equation in x and y.
template <class ExecutionSpace>
struct PlaneModes {
  typename SlabLines<ExecutionSpace>::List x, y;  ///< eigenvalues of the Laplacian, 1/m^2
  int parts = 1;                                  ///< numbers of a coefficient
  double normalisation = 1.0;                     ///< factor that undoes the growth by two transforms
};

/// Lines of the nodes `begin` to `end` - 1 along z, for the Laplacian.
/// Allocates; blocks. Throws std::invalid_argument for a slab without nodes, an axis z that the solution does
/// not vary along, widths that are wrong, or complex coefficients on hosts, and std::runtime_error if memory
/// runs out.
template <class ExecutionSpace>
SlabLines<ExecutionSpace> make_slab_lines(const ExecutionSpace& space, PoissonProblem problem, int begin,
                                          int end, const PlaneModes<ExecutionSpace>& modes) {
  if (!problem.varies_along(2) || begin < 0 || begin >= end || end > problem.cells[2])
    throw std::invalid_argument("a slab needs cells along z");
  if (device::is_host<ExecutionSpace> && modes.parts != 1)
    throw std::invalid_argument("lines of complex coefficients need a device");
  const AxisConditions& ends = problem.axes[2];
  if (problem.widths[2].empty())
    problem.widths[2].assign(static_cast<std::size_t>(problem.cells[2] + (ends.on_inner_faces() ? 1 : 0)),
                             problem.spacing[2]);
  const StretchedAxis axis = stretched_axis(problem, 2);
  const auto part = [&](const char* label, const std::vector<double>& values, int last) {
    return to_device(space, label, std::vector<double>(values.begin() + begin, values.begin() + last));
  };
  SlabLines<ExecutionSpace> slab{
      .length = end - begin,
      .parts = modes.parts,
      .x = modes.x,
      .y = modes.y,
      .lengths = part("drogue::linear::lengths", axis.lengths, end),
      .conductances = part("drogue::linear::conductances", axis.conductances, end + 1),
      .low_end = ends.periodic || begin > 0 ? 0.0 : axis.conductances.front(),
      .has_high_end = !ends.periodic && end == problem.cells[2],
      .normalisation = modes.normalisation,
      .has_constant = problem.is_singular(),
      .whole = std::accumulate(axis.lengths.begin(), axis.lengths.end(), 0.0),
      .is_singular = problem.is_singular(),
      .spectral_operator = {},
      .inverse_pivots = {},
      .couplings = {},
      .uniform = {}};
  slab.inverse_pivots = allocate_list(space, "drogue::linear::inverse_pivots", slab.at(slab.length - 1, 0));
  slab.couplings = allocate_list(space, "drogue::linear::couplings", slab.at(slab.batches(), 0));
  slab.uniform = allocate_list(space, "drogue::linear::uniform_source", slab.batches());
  return slab;
}

/// Rows for slab number `number` of `slabs`. Allocates. Throws std::runtime_error if memory runs out.
template <class ExecutionSpace>
SlabSeparators<ExecutionSpace> make_slab_separators(const ExecutionSpace& space,
                                                    const SlabLines<ExecutionSpace>& slab, int slabs,
                                                    int number) {
  const std::int64_t size = slab.at(slabs, 0);
  return {.slabs = slabs,
          .slab = number,
          .low = allocate_list(space, "drogue::linear::low_separators", size),
          .high = allocate_list(space, "drogue::linear::high_separators", size),
          .work = allocate_list(space, "drogue::linear::separator_work", size),
          .means = allocate_list(space, "drogue::linear::separator_means", slabs)};
}

}  // namespace drogue::linear
