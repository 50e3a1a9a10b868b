#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
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
  /// Nodes whose loads are under way together: the recurrences do not wait for each.
  static constexpr int batch = 20;

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

/// Eliminates the interior of a system, and sends its ports: the conductance between both separators, and the
/// shunts that it leaves at the own and at the next one. For a singular system also the sources there and the
/// sum of w u in the interior for the source w, between separators with the value zero.
template <class ExecutionSpace>
struct FactorSlabFunctor {
  SlabLines<ExecutionSpace> slab;
  double* ports;

  KOKKOS_FUNCTION void operator()(const int mode) const {
    const auto [diffusivity, reaction, source] = slab.equation();
    const int modes = slab.modes();
    const bool is_singular = slab.is_singular && mode == 0;
    const double shunt =
        reaction - diffusivity * (slab.x(mode % slab.x.extent_int(0)) + slab.y(mode / slab.x.extent_int(0)));
    double across = diffusivity * slab.conductances(1);
    double low = slab.lengths(0) * shunt + diffusivity * slab.low_end, high = 0.0;
    double low_source = slab.lengths(0), high_source = 0.0, moment = 0.0;
    for (int k = 1; k < slab.length; ++k) {
      const double above = diffusivity * slab.conductances(k + 1), ground = high + slab.lengths(k) * shunt;
      const double inverse = 1.0 / (across + ground + above);
      slab.inverse_pivots(slab.at(k - 1, mode)) = inverse;
      const int in_batch = (k - 1) % slab.batch, of_batch = (k - 1) / slab.batch;
      if (in_batch == 0) slab.couplings(slab.at(of_batch, mode)) = across;
      if (is_singular) {
        const double eliminated = slab.lengths(k) + high_source;
        if (in_batch == 0) slab.uniform(of_batch) = eliminated;
        low_source += across * inverse * eliminated;
        moment += inverse * eliminated * eliminated;
        high_source = above * inverse * eliminated;
      }
      low += across * ground * inverse;
      high = above * ground * inverse;
      across = slab.next_coupling(across, above * inverse);
    }
    const double beyond = slab.has_high_end ? 0.0 : 1.0;
    ports[mode] = beyond * across;
    ports[modes + mode] = low + (1.0 - beyond) * across;
    ports[2 * modes + mode] = beyond * high;
    if (!is_singular) return;
    ports[3 * modes] = low_source;
    ports[3 * modes + 1] = beyond * high_source;
    ports[3 * modes + 2] = moment;
  }
};

/// Reduced system of a mode: a ring of separators; a chain if the conductance from the last to the first is
/// zero.
struct SeparatorRing {
  int slabs;
  std::int64_t modes, count;  ///< `count`: distance of the ports of slabs
  const double* ports;        ///< of the mode
  double grounding;           ///< shunt at the first separator, which makes a singular system regular

  [[nodiscard]] KOKKOS_FUNCTION double conductance(int slab) const { return ports[slab * count]; }
  [[nodiscard]] KOKKOS_FUNCTION double shunt(int slab) const {
    return ports[slab * count + modes] + ports[(slab + slabs - 1) % slabs * count + 2 * modes] +
           (slab == 0 ? grounding : 0.0);
  }

  /// Row of the inverse, in `row` and with the help of `work`, at distances of `modes`: the unknowns for the
  /// source 1 at separator `source`. From there around the ring, it eliminates one after the other.
  KOKKOS_FUNCTION void invert(int source, double* row, double* work) const {
    double across = conductance(source), carried = 0.0, ground = shunt(source);
    for (int step = 1; step < slabs; ++step) {
      const int slab = (source + step) % slabs;
      const double own = shunt(slab) + carried, above = conductance(slab);
      const double inverse = 1.0 / (across + own + above);
      row[slab * modes] = across * inverse;
      work[slab * modes] = above * inverse;
      ground += own * across * inverse;
      carried = own * above * inverse;
      across = across * above * inverse;
    }
    // The last one is connected to the source on both sides.
    const double at_source = 1.0 / (ground + carried);
    row[source * modes] = at_source;
    double above = at_source;
    for (int step = slabs - 1; step > 0; --step) {
      const int slab = (source + step) % slabs;
      above = row[slab * modes] * at_source + work[slab * modes] * above;
      row[slab * modes] = above;
    }
  }
};

/// Rows of the inverse of a reduced system, from the ports of all slabs. Those of a singular system include
/// the subtraction of both means: s = row . (b, the sources at the separators) - sum of the slabs' moments /
/// whole.
template <class ExecutionSpace>
struct ConnectSlabsFunctor {
  SlabLines<ExecutionSpace> lines;
  SlabSeparators<ExecutionSpace> separators;
  const double* ports;

  KOKKOS_FUNCTION void operator()(const int mode) const {
    const int slabs = separators.slabs, own = separators.slab;
    const bool is_singular = lines.is_singular && mode == 0;
    const SeparatorRing ring{.slabs = slabs,
                             .modes = lines.modes(),
                             .count = lines.port_count(),
                             .ports = ports + mode,
                             .grounding = is_singular ? 1.0 / lines.whole : 0.0};
    double* low = separators.low.data() + mode;
    double* high = separators.high.data() + mode;
    double* work = separators.work.data() + mode;
    if (is_singular) {
      set_means(ring, low, work);
      return;
    }
    ring.invert(own, low, work);
    if (lines.has_high_end)
      for (int slab = 0; slab < slabs; ++slab) high[slab * ring.modes] = 0.0;
    else
      ring.invert((own + 1) % slabs, high, work);
  }

 private:
  /// Source of a separator for the source w of all nodes: its weight in the mean of the unknowns.
  [[nodiscard]] KOKKOS_FUNCTION double weight(const SeparatorRing& ring, int slab) const {
    const double *own = ring.ports + slab * ring.count + 3 * ring.modes,
                 *below = ring.ports + (slab + ring.slabs - 1) % ring.slabs * ring.count + 3 * ring.modes;
    return own[0] + below[1];
  }

  /// With the inverse G, the weights W and their sum w, and b' = b - (sum of b / w) W: the unknowns for b'
  /// are G b', and their mean is (W . G b' + moments of b') / w.
  KOKKOS_FUNCTION void set_means(const SeparatorRing& ring, double* row, double* work) const {
    const int slabs = ring.slabs, own = separators.slab;
    double moments = 0.0;
    for (int slab = 0; slab < slabs; ++slab) {
      ring.invert(slab, row, work);
      double product = 0.0;
      for (int other = 0; other < slabs; ++other) product += row[other * ring.modes] * weight(ring, other);
      separators.means(slab) = product;
      moments += ring.ports[slab * ring.count + 3 * ring.modes + 2];
    }
    for (int next = 0; next < 2; ++next) {
      double* of_separator = (next == 0 ? separators.low : separators.high).data();
      ring.invert((own + next) % slabs, of_separator, work);
      double product = 0.0;
      for (int slab = 0; slab < slabs; ++slab) {
        of_separator[slab * ring.modes] -= separators.means(slab) / lines.whole;
        product += of_separator[slab * ring.modes] * weight(ring, slab);
      }
      for (int slab = 0; slab < slabs; ++slab)
        of_separator[slab * ring.modes] += (moments / lines.whole - product) / lines.whole;
    }
  }
};

/// Lines that a work item treats: one on a device, a block on hosts, whose compilers vectorise it.
template <class ExecutionSpace>
inline constexpr int lines_per_item = device::is_host<ExecutionSpace> ? 64 : 1;

/// Eliminates the interior of lines with a source f, which it replaces by eliminated sources but for that of
/// the separator. Sends the sources that it leaves at the own separator and at the next one; of singular
/// lines also the sum of w u in the interior, between separators with the value zero.
template <class ExecutionSpace>
struct ReduceSlabFunctor {
  static constexpr int width = lines_per_item<ExecutionSpace>, batch = SlabLines<ExecutionSpace>::batch;
  SlabLines<ExecutionSpace> slab;
  double *values, *sources;

  KOKKOS_FUNCTION void operator()(const int item) const {
    if (item * width < slab.singular_lines())
      reduce<true>(item * width);
    else
      reduce<false>(item * width);
  }

 private:
  template <bool has_moment>
  KOKKOS_FUNCTION void reduce(int first) const {
    const auto [diffusivity, reaction, source] = slab.equation();
    const int lines = slab.lines(), count = width == 1 || first + width <= lines ? width : lines - first;
    const int mode = width == 1 ? first / slab.parts : first, n = slab.length;
    double low[width], high[width], coupling[width], uniform = 0.0, moment[width] = {};
    for (int a = 0; a < count; ++a) {
      low[a] = source * slab.lengths(0) * values[first + a];
      high[a] = 0.0;
      coupling[a] = diffusivity * slab.conductances(1);
    }
    for (int begin = 1; begin < n; begin += batch) {
      double f[batch][width], pivot[batch][width];
      for (int k = 0; k < batch; ++k)
        if (begin + k < n)
          for (int a = 0; a < count; ++a) {
            f[k][a] = values[static_cast<std::int64_t>(begin + k) * lines + first + a];
            pivot[k][a] = slab.inverse_pivots(slab.at(begin + k - 1, mode + a));
          }
      for (int k = 0; k < batch; ++k)
        if (begin + k < n) {
          const double factor = source * slab.lengths(begin + k),
                       above = diffusivity * slab.conductances(begin + k + 1);
          for (int a = 0; a < count; ++a) {
            f[k][a] = factor * f[k][a] + high[a];
            const double value = pivot[k][a] * f[k][a];
            low[a] += coupling[a] * value;
            high[a] = above * value;
            coupling[a] = slab.next_coupling(coupling[a], above * pivot[k][a]);
          }
          if constexpr (has_moment) {
            uniform += slab.lengths(begin + k);
            for (int a = 0; a < slab.parts && a < count; ++a) moment[a] += uniform * pivot[k][0] * f[k][a];
            uniform *= above * pivot[k][0];
          }
        }
      for (int k = 0; k < batch; ++k)
        if (begin + k < n)
          for (int a = 0; a < count; ++a)
            values[static_cast<std::int64_t>(begin + k) * lines + first + a] = f[k][a];
    }
    for (int a = 0; a < count; ++a) {
      sources[first + a] = low[a];
      sources[lines + first + a] = slab.has_high_end ? 0.0 : high[a];
    }
    if constexpr (has_moment)
      for (int a = 0; a < slab.parts && a < count; ++a) sources[2 * lines + first + a] = moment[a];
  }
};

/// Unknowns at both separators of lines from the sources of all slabs, and those between them from the
/// eliminated sources, which it replaces.
template <class ExecutionSpace>
struct SubstituteSlabFunctor {
  static constexpr int width = lines_per_item<ExecutionSpace>, batch = SlabLines<ExecutionSpace>::batch;
  SlabLines<ExecutionSpace> slab;
  SlabSeparators<ExecutionSpace> separators;
  const double* sources;
  double* values;

  KOKKOS_FUNCTION void operator()(const int item) const {
    if (item * width < slab.singular_lines())
      substitute<true>(item * width);
    else
      substitute<false>(item * width);
  }

 private:
  template <bool has_mean>
  KOKKOS_FUNCTION void substitute(int first) const {
    const auto [diffusivity, reaction, source] = slab.equation();
    const int lines = slab.lines(), count = width == 1 || first + width <= lines ? width : lines - first;
    const int mode = width == 1 ? first / slab.parts : first, n = slab.length;
    double low[width] = {}, carried[width] = {}, mean[width] = {};
    for (int other = 0; other < separators.slabs; ++other) {
      const int below = (other + separators.slabs - 1) % separators.slabs;
      const double* own = sources + other * static_cast<std::int64_t>(slab.source_count()) + first;
      const double* next = sources + below * static_cast<std::int64_t>(slab.source_count()) + lines + first;
      for (int a = 0; a < count; ++a) {
        const double at_separator = own[a] + next[a];
        low[a] += separators.low(slab.at(other, mode + a)) * at_separator;
        carried[a] += separators.high(slab.at(other, mode + a)) * at_separator;
        if constexpr (has_mean) mean[a] -= at_separator / slab.whole;
      }
      if constexpr (has_mean)
        for (int a = 0; a < slab.parts && a < count; ++a) {
          const double level = own[2 * lines + a] / slab.whole;
          low[a] -= level;
          carried[a] -= level;
        }
    }
    for (int a = 0; a < count; ++a) {
      values[first + a] = low[a];
      carried[a] *= slab.has_high_end ? 0.0 : diffusivity * slab.conductances(n);
    }
    for (int of_batch = slab.batches(); of_batch-- > 0;) {
      const int begin = 1 + of_batch * batch;
      double f[batch][width], pivot[batch][width], coupling[width];
      for (int a = 0; a < count; ++a) coupling[a] = slab.couplings(slab.at(of_batch, mode + a));
      for (int k = 0; k < batch; ++k)
        if (begin + k < n)
          for (int a = 0; a < count; ++a) {
            f[k][a] = values[static_cast<std::int64_t>(begin + k) * lines + first + a];
            pivot[k][a] = slab.inverse_pivots(slab.at(begin + k - 1, mode + a));
          }
      double uniform = 0.0;
      if constexpr (has_mean) uniform = slab.uniform(of_batch);
      for (int k = 0; k < batch; ++k)
        if (begin + k < n) {
          const double above = diffusivity * slab.conductances(begin + k + 1);
          for (int a = 0; a < count; ++a) {
            f[k][a] += coupling[a] * low[a];
            coupling[a] = slab.next_coupling(coupling[a], above * pivot[k][a]);
          }
          if constexpr (has_mean) {
            for (int a = 0; a < slab.parts && a < count; ++a) f[k][a] += mean[a] * uniform;
            if (begin + k + 1 < n) uniform = slab.lengths(begin + k + 1) + uniform * above * pivot[k][0];
          }
        }
      for (int k = batch - 1; k >= 0; --k)
        if (begin + k < n) {
          const double below = diffusivity * slab.conductances(begin + k);
          for (int a = 0; a < count; ++a) {
            f[k][a] = pivot[k][a] * (f[k][a] + carried[a]);
            carried[a] = below * f[k][a];
          }
        }
      for (int k = 0; k < batch; ++k)
        if (begin + k < n)
          for (int a = 0; a < count; ++a)
            values[static_cast<std::int64_t>(begin + k) * lines + first + a] = f[k][a];
    }
  }
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

/// Eliminates the interiors of a slab, to send its ports: `port_count()` numbers. Asynchronous. Does not
/// throw.
template <class ExecutionSpace>
void factor_slab(const ExecutionSpace& space, const SlabLines<ExecutionSpace>& slab, double* ports) {
  device::launch_each(space, "drogue::linear::factor_slab", slab.modes(),
                      FactorSlabFunctor<ExecutionSpace>{slab, ports});
}

/// Prepares the reduced systems from the ports of all slabs, one after the other. Asynchronous. Does not
/// throw.
template <class ExecutionSpace>
void connect_slabs(const ExecutionSpace& space, const SlabLines<ExecutionSpace>& slab,
                   const SlabSeparators<ExecutionSpace>& separators, const double* ports) {
  device::launch_each(space, "drogue::linear::connect_slabs", slab.modes(),
                      ConnectSlabsFunctor<ExecutionSpace>{slab, separators, ports});
}

/// Replaces the right-hand sides f of the lines of a slab by eliminated ones, to send the sources at
/// separators: `source_count()` numbers. Asynchronous. Does not throw.
template <class ExecutionSpace>
void reduce_slab(const ExecutionSpace& space, const SlabLines<ExecutionSpace>& slab,
                 const typename SlabLines<ExecutionSpace>::List& values, double* sources) {
  constexpr int width = lines_per_item<ExecutionSpace>;
  device::launch_each<Kokkos::LaunchBounds<32, 1>>(
      space, "drogue::linear::reduce_slab", (slab.lines() + width - 1) / width,
      ReduceSlabFunctor<ExecutionSpace>{slab, values.data(), sources});
}

/// Replaces what `reduce_slab` left by the unknowns, from the sources of all slabs, one after the other.
/// Asynchronous. Does not throw.
template <class ExecutionSpace>
void substitute_slab(const ExecutionSpace& space, const SlabLines<ExecutionSpace>& slab,
                     const SlabSeparators<ExecutionSpace>& separators,
                     const typename SlabLines<ExecutionSpace>::List& values, const double* sources) {
  constexpr int width = lines_per_item<ExecutionSpace>;
  device::launch_each<Kokkos::LaunchBounds<32, 1>>(
      space, "drogue::linear::substitute_slab", (slab.lines() + width - 1) / width,
      SubstituteSlabFunctor<ExecutionSpace>{slab, separators, sources, values.data()});
}

}  // namespace drogue::linear
