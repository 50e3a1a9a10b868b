#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/linear/poisson/slab_lines.hpp"

// What is computed once for an operator: elimination of the interiors, and the reduced systems.

namespace drogue::linear {

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

}  // namespace drogue::linear
