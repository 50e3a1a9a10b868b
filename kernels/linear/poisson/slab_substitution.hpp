#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/poisson/slab_lines.hpp"

// What each solve takes: elimination of the sources, and substitution.

namespace drogue::linear {

/// Lines that a work item treats: one on a device, a block on hosts, whose compilers vectorise it.
template <class ExecutionSpace>
inline constexpr int lines_per_item = device::is_host<ExecutionSpace> ? 64 : 1;

/// Small blocks, since a plane has a few warps for each multiprocessor, of which it holds 16 at once.
using SlabBounds = Kokkos::LaunchBounds<32, 16>;

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
    // Clang before 16 captures no structured bindings.
    const LineEquation equation = slab.equation();
    const double diffusivity = equation.diffusivity, source = equation.source;
    const int lines = slab.lines(), count = width == 1 || first + width <= lines ? width : lines - first;
    const int mode = width == 1 ? first / slab.parts : first, n = slab.length;
    double low[width], high[width], coupling[width], uniform = 0.0, moment[width] = {};
    for (int a = 0; a < count; ++a) {
      low[a] = source * slab.lengths(0) * values[first + a];
      high[a] = 0.0;
      coupling[a] = diffusivity * slab.conductances(1);
    }
    const auto batch_of = [&]<bool is_full>(int begin) {
      double f[batch][width], pivot[batch][width];
      for (int k = 0; k < batch; ++k)
        if (is_full || begin + k < n)
          for (int a = 0; a < count; ++a) {
            f[k][a] = values[static_cast<std::int64_t>(begin + k) * lines + first + a];
            pivot[k][a] = slab.inverse_pivots(slab.at(begin + k - 1, mode + a));
          }
      for (int k = 0; k < batch; ++k)
        if (is_full || begin + k < n) {
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
        if (is_full || begin + k < n)
          for (int a = 0; a < count; ++a)
            values[static_cast<std::int64_t>(begin + k) * lines + first + a] = f[k][a];
    };
    int begin = 1;
    for (; begin + batch <= n; begin += batch) batch_of.template operator()<true>(begin);
    if (begin < n) batch_of.template operator()<false>(begin);
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
    const double diffusivity = slab.equation().diffusivity;
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
    const auto batch_of = [&]<bool is_full>(int of_batch) {
      const int begin = 1 + of_batch * batch;
      double f[batch][width], pivot[batch][width], coupling[width];
      for (int a = 0; a < count; ++a) coupling[a] = slab.couplings(slab.at(of_batch, mode + a));
      for (int k = 0; k < batch; ++k)
        if (is_full || begin + k < n)
          for (int a = 0; a < count; ++a) {
            f[k][a] = values[static_cast<std::int64_t>(begin + k) * lines + first + a];
            pivot[k][a] = slab.inverse_pivots(slab.at(begin + k - 1, mode + a));
          }
      [[maybe_unused]] double uniform = has_mean ? slab.uniform(of_batch) : 0.0;
      for (int k = 0; k < batch; ++k)
        if (is_full || begin + k < n) {
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
        if (is_full || begin + k < n) {
          const double below = diffusivity * slab.conductances(begin + k);
          for (int a = 0; a < count; ++a) {
            f[k][a] = pivot[k][a] * (f[k][a] + carried[a]);
            carried[a] = below * f[k][a];
          }
        }
      for (int k = 0; k < batch; ++k)
        if (is_full || begin + k < n)
          for (int a = 0; a < count; ++a)
            values[static_cast<std::int64_t>(begin + k) * lines + first + a] = f[k][a];
    };
    int of_batch = slab.batches();
    if (of_batch * batch > n - 1) batch_of.template operator()<false>(--of_batch);
    while (of_batch-- > 0) batch_of.template operator()<true>(of_batch);
  }
};

/// Replaces the right-hand sides f of the lines of a slab by eliminated ones, to send the sources at
/// separators: `source_count()` numbers. Asynchronous. Does not throw.
template <class ExecutionSpace>
void reduce_slab(const ExecutionSpace& space, const SlabLines<ExecutionSpace>& slab,
                 const typename SlabLines<ExecutionSpace>::List& values, double* sources) {
  constexpr int width = lines_per_item<ExecutionSpace>;
  device::launch_each<SlabBounds>(space, "drogue::linear::reduce_slab", (slab.lines() + width - 1) / width,
                                  ReduceSlabFunctor<ExecutionSpace>{slab, values.data(), sources});
}

/// Replaces what `reduce_slab` left by the unknowns, from the sources of all slabs, one after the other.
/// Asynchronous. Does not throw.
template <class ExecutionSpace>
void substitute_slab(const ExecutionSpace& space, const SlabLines<ExecutionSpace>& slab,
                     const SlabSeparators<ExecutionSpace>& separators,
                     const typename SlabLines<ExecutionSpace>::List& values, const double* sources) {
  constexpr int width = lines_per_item<ExecutionSpace>;
  device::launch_each<SlabBounds>(
      space, "drogue::linear::substitute_slab", (slab.lines() + width - 1) / width,
      SubstituteSlabFunctor<ExecutionSpace>{slab, separators, sources, values.data()});
}

}  // namespace drogue::linear
