#pragma once

#include "kernels/options/pide/error_estimate.hpp"
#include "kernels/options/pide/register_march.hpp"
#include "kernels/options/pide/solution.hpp"

namespace drogue::options {

/// Scratch memory of one option (or pack) for its two solves. For `fixed` see `solve`: a fixed mesh needs
/// little memory, so that many warps share a multiprocessor.
template <class R, int fixed>
struct SolveMemory {
  static constexpr int members = device::Access<R>::lanes;

  R* tables;   ///< mixture of `make_levy_measure`, then the step table, finally an error estimate for another
               ///< warp
  R* scratch;  ///< (9 max_lanes); with a fixed mesh for `domain_of` or the multipliers
  R* w;        ///< in the order of a WeightLayout
  R* nodes;    ///< rows of `node_count`; the coarser solve has shorter rows and stores data beyond them
  NormalizedPut* puts;        ///< (members)
  SolutionAtSpot* solutions;  ///< (2, members): on the finer and on the coarser grid
  double*
      european_values;  ///< (members): values next to the spots on the coarser grid, without early exercise

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t bytes(int mesh) {
    const std::size_t all =
        sizeof(R) * static_cast<std::size_t>(table_size + scratch_size + WeightLayout<R>(mesh).size() +
                                             node_size(mesh)) +
        members * (sizeof(NormalizedPut) + 2 * sizeof(SolutionAtSpot) + sizeof(double));
    return (all + 63) / 64 * 64;
  }
  KOKKOS_INLINE_FUNCTION SolveMemory(void* place, int mesh)
      : tables(static_cast<R*>(place)),
        scratch(tables + table_size),
        w(scratch + scratch_size),
        nodes(w + WeightLayout<R>(mesh).size()),
        puts(reinterpret_cast<NormalizedPut*>(nodes + node_size(mesh))),
        solutions(reinterpret_cast<SolutionAtSpot*>(puts + members)),
        european_values(reinterpret_cast<double*>(solutions + 2 * members)) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* row(int k, int mesh) const { return nodes + k * node_count(mesh); }
  /// Error estimate in the memory of the mixture, which is no longer needed.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION ErrorEstimate<R>* estimate() const {
    return reinterpret_cast<ErrorEstimate<R>*>(tables);
  }
  /// Spectrum of the weights of a transformed mesh, in its last two rows. If lanes keep it in registers the
  /// rows are only used for its computation.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION ComplexNumber<R>* spectrum(int mesh) const {
    return reinterpret_cast<ComplexNumber<R>*>(row(passes_through ? 1 : rows(mesh) - 2, mesh));
  }
  /// Weights of the coarser grid, followed by every second value of the finer one (`fine_values`). They do
  /// not overlap the rows 0 to 2 of the finer solve, which are read last.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* coarse_weights(int mesh) const {
    return row(rows(mesh / 2), mesh / 2);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* fine_values(int mesh) const {
    return coarse_weights(mesh) + WeightLayout<R>(mesh / 2).size();
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION LevyMeasure<R> measure_memory() const {
    return {.s = tables,
            .c = tables + Mixture::size,
            .up = tables + 2 * Mixture::size,
            .down = tables + 2 * Mixture::size + Mixture::low,
            .variance = R(0.0),
            .high = R(0.0)};
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* ratio() const { return tables + 3 * Mixture::size; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* symbol() const { return tables + StepFactors<R>::size * max_lanes; }

 private:
  static constexpr bool passes_through = fixed > 0 && keeps_spectrum(lanes_of(fixed));
  static constexpr int table_size = StepFactors<R>::size * max_lanes + symbol_count;
  static constexpr int scratch_size = fixed == 0              ? 9 * max_lanes
                                      : fixed < 3 * max_lanes ? 3 * max_lanes
                                                              : fixed;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static int rows(int mesh) {
    return (fixed > 0 ? 5 : 11) + (is_transformed(mesh, 1) && !passes_through ? 2 : 0);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static int node_size(int mesh) {
    const int coarse =
                  rows(mesh / 2) * node_count(mesh / 2) + WeightLayout<R>(mesh / 2).size() + mesh / 2 + 2,
              fine = rows(mesh) * node_count(mesh);
    return fine > coarse ? fine : coarse;
  }
};

/// Optional output arrays for the first member of a solve, in the memory of the backend; null if nothing is
/// recorded.
struct MarchRecord {
  double* time = nullptr;  ///< (steps): time to expiry, years
  double* boundary;        ///< (steps): x of the boundary at these times
  double* x;               ///< (mesh + 1): nodes
  double* value;           ///< (mesh + 1): values at maturity
};

/// Marches with the nodes in rows 0 to 8 of the memory. Not inlined: if the code of both solves makes a
/// kernel too large, a GPU compiler does not inline other functions.
template <class ThreadGroup, class R>
[[gnu::noinline]] KOKKOS_FUNCTION March<R> march_in_memory(const ThreadGroup& group, const PutPack<R>& put,
                                                           const Jumps<R>& jumps, const Grid<R>& grid,
                                                           const JumpSpectrum<R>& spectrum,
                                                           const Scheme<R>& scheme, const StepTable<R>& table,
                                                           const SolveMemory<R, 0>& memory, R strike_value,
                                                           const MarchRecord& record) {
  const int mesh = grid.mesh, count = node_count(mesh), steps = scheme.steps;
  const R h = grid.h;
  March<R> march{.value = {memory.row(0, mesh), memory.row(1, mesh), memory.row(2, mesh)},
                 .jump = {memory.row(3, mesh), memory.row(4, mesh)},
                 .other = memory.row(5, mesh),
                 .y = memory.row(6, mesh),
                 .floor = memory.row(7, mesh),
                 .multiplier = memory.row(8, mesh),
                 .scratch = memory.scratch};
  group.each([=](int thread) {
    for (int k = thread; k < 9 * count; k += group.threads()) memory.nodes[k] = 0.0;
  });
  group.each([=, &put](int thread) {
    for (int i = thread; i < mesh; i += group.threads()) {
      const InitialNode<R> node = initial_node(put, grid, i, strike_value);
      march.value[1][i] = node.value;
      march.floor[i] = node.floor;
    }
  });
  DiscountFactors<R> discount{R(1.0), R(1.0)};
  for (int n = 1; n <= steps; ++n) {
    if (n % max_lanes == 1) fill_table(group, put, jumps, scheme, table, n);
    const StepFactors<R> factors = table.load(n);
    step(group, put, jumps, grid, spectrum, march, factors, discount);
    discount = factors.discount;
    if (record.time != nullptr) {
      group.each([=, &put](int lane) {
        if (lane != 0) return;
        const auto strike = static_cast<int>(device::Access<R>::lane(grid.strike, 0));
        const double width = device::Access<R>::lane(h, 0);
        const MemberValues values{reinterpret_cast<const double*>(march.value[0]), device::Access<R>::lanes};
        record.time[n - 1] = device::Access<R>::lane(step_end(put.maturity, n, steps), 0);
        record.boundary[n - 1] =
            memory.puts[0].early ? boundary_of(values, last_exercised(values, strike, width), strike, width)
                                 : device::portable::not_a_number();
      });
    }
    R* const oldest = march.value[2];
    march.value[2] = march.value[1];
    march.value[1] = march.value[0];
    march.value[0] = oldest;
    R* const jump = march.jump[0];
    march.jump[0] = march.jump[1];
    march.jump[1] = jump;
  }
  // After the rotation value[0] is the former value[2].
  const StepLength<R> last = step_length(put.maturity, steps, steps);
  group.each([=](int thread) {
    for (int i = thread; i <= mesh;
         i += group.threads())  // includes the upper end, where transforms leave other values
      march.y[i] = bdf_derivative(last, march.value[1][i], march.value[2][i], march.value[0][i]);
  });
  if (record.time != nullptr) {
    group.each([=](int thread) {
      for (int i = thread; i <= mesh; i += group.threads()) {
        record.x[i] = device::Access<R>::lane((double(i) - grid.strike) * h, 0);
        record.value[i] = device::Access<R>::lane(march.value[1][i], 0);
      }
    });
  }
  return march;
}

/// Result of a march on the nodes of a pack, valid in the memory until the next march.
template <class R>
struct MarchResult {
  const R *value, *time_derivative;  ///< V and dV/dtau at maturity
  int exercised;                     ///< last exercised node below the strike, for marches in registers
};

template <class R>
KOKKOS_INLINE_FUNCTION MemberValues member_values(const R* nodes, int member) {
  return {reinterpret_cast<const double*>(nodes) + member, device::Access<R>::lanes};
}

/// Grid of member k.
template <int fixed, class R>
KOKKOS_INLINE_FUNCTION MemberGrid member_grid(const MarchResult<R>& solution, const NormalizedPut& put,
                                              const Grid<R>& grid, int k) {
  const auto member = [k](const R& number) { return device::Access<R>::lane(number, k); };
  const MemberValues values = member_values(solution.value, k);
  const int strike = static_cast<int>(member(grid.strike));
  const double h = member(grid.h);
  const int last = fixed > 0 ? solution.exercised : put.early ? last_exercised(values, strike, h) : -1;
  return {grid.mesh, strike, last, h};
}

/// Jumps on `grid`, with the weights in `weights`; with `finer`, the weights of a grid of half the step,
/// mixtures use these. For `fixed` see `march_nodes`.
template <int fixed, class ThreadGroup, class R, class Scratch>
KOKKOS_INLINE_FUNCTION Jumps<R> jumps_on_grid(const ThreadGroup& group, const PutPack<R>& put,
                                              const LevyMeasure<R>& measure, const Tails<R>& tails,
                                              const Grid<R>& grid, const Scratch& memory, R* weights,
                                              const R* finer = nullptr) {
  const int mesh = mesh_for<fixed>(grid.mesh);
  constexpr int left = fixed > 0 ? 3 : 9;
  return discretize_jumps(group, put, measure, tails, grid,
                          {.w = weights,
                           .exit_mass = memory.row(left, mesh),
                           .exit_price = memory.row(left + 1, mesh),
                           .symbol = memory.symbol(),
                           .even = memory.row(1, mesh),
                           .odd = memory.row(2, mesh),
                           .both = memory.row(0, mesh),
                           .ratio = memory.ratio(),
                           .scratch = memory.scratch},
                          finer);
}

/// Variance by which Brownian motion and jumps within a step spread the payoff until maturity.
template <class R>
KOKKOS_INLINE_FUNCTION R payoff_spread(const PutPack<R>& put, const Jumps<R>& jumps) {
  return 2.0 * (jumps.diffusion - jumps.moved) * put.maturity;
}

/// Error estimate of a solve on `grid` that is compared with one on the coarser grid.
template <class R>
KOKKOS_INLINE_FUNCTION ErrorEstimate<R> estimate_solve_error(const PutPack<R>& put,
                                                             const LevyMeasure<R>& measure,
                                                             const Jumps<R>& jumps, const Grid<R>& grid,
                                                             int steps) {
  ErrorEstimate<R> estimate = estimate_error(put, measure, jumps, grid.h, steps, payoff_spread(put, jumps));
  estimate.offset += stiff_jump_error(put, measure, jumps, steps, grid.h);
  if (put.model == JumpModel::merton || put.model == JumpModel::kou) {
    estimate.factor = device::maximum(estimate.factor, frequent_jump_factor(put, measure, jumps, steps));
    estimate.offset += rare_jump_truncation(put, grid.mesh);
  }
  return estimate;
}

/// Marches from expiry to maturity on `grid`. With `fixed` > 0 the mesh is `fixed`, the nodes are kept in the
/// registers of the lanes, and nothing is recorded.
template <int fixed, class ThreadGroup, class R, class Scratch>
KOKKOS_INLINE_FUNCTION MarchResult<R> march_nodes(const ThreadGroup& group, const PutPack<R>& put,
                                                  const Jumps<R>& jumps, const Grid<R>& grid, int steps,
                                                  const Scratch& memory, const FourierRoots& roots,
                                                  const MarchRecord& record = {}) {
  const int mesh = mesh_for<fixed>(grid.mesh);
  // Smoothed value of the payoff's kink: the trapezoidal rule, which sums over nodes represent, has the error
  // h/12 there.
  const R spread = payoff_spread(put, jumps);
  const R strike_value = grid.h * (1.0 / 12) * spread / (spread + grid.h * grid.h);
  const Scheme<R> scheme = scheme_of(put, jumps, grid, steps);
  const StepTable<R> table{memory.tables};
  JumpSpectrum<R> spectrum{};
  if (is_transformed(mesh, group.lanes))
    spectrum = spectrum_of(group, mesh, roots, jumps.w, memory.spectrum(mesh));
  if constexpr (fixed > 0) {
    const RegisterRows rows{memory.row(0, mesh), memory.row(1, mesh), memory.row(2, mesh), memory.scratch};
    const auto march = [&]<int block, bool halved>(const auto& threads) -> MarchResult<R> {
      return {rows.value, rows.other,
              march_in_registers<block, halved>(threads, put, jumps, grid, spectrum, scheme, table, rows,
                                                strike_value)};
    };
    if constexpr (ThreadGroup::is_single && fixed == 8 * ThreadGroup::lanes)
      return march.template operator()<fixed / max_lanes, true>(WarpThreadGroup<>(group.thread));
    else
      return march.template operator()<fixed / ThreadGroup::lanes, false>(group);
  } else {
    const March<R> march =
        march_in_memory(group, put, jumps, grid, spectrum, scheme, table, memory, strike_value, record);
    return {march.value[1], march.y, -1};
  }
}

/// `march_nodes`, then `solutions` (members) are interpolated.
template <int fixed, class ThreadGroup, class R, class Scratch>
KOKKOS_INLINE_FUNCTION MarchResult<R> solve(const ThreadGroup& group, const PutPack<R>& put,
                                            const Jumps<R>& jumps, const Grid<R>& grid, int steps,
                                            const Scratch& memory, const FourierRoots& roots,
                                            SolutionAtSpot* solutions, const MarchRecord& record = {}) {
  constexpr int members = device::Access<R>::lanes;
  const MarchResult<R> solution = march_nodes<fixed>(group, put, jumps, grid, steps, memory, roots, record);
  group.each([=](int thread) {
    for (int k = thread; k < members; k += group.threads()) {
      solutions[k] = solution_at_spot(memory.puts[k], member_values(solution.value, k),
                                      member_values(solution.time_derivative, k),
                                      member_grid<fixed>(solution, memory.puts[k], grid, k));
    }
  });
  return solution;
}

}  // namespace drogue::options
