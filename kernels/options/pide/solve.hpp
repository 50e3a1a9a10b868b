#pragma once

#include "kernels/options/pide/error_estimate.hpp"
#include "kernels/options/pide/register_march.hpp"
#include "kernels/options/pide/solution.hpp"

namespace drogue::options {

/// Scratch memory of one option (or pack) for its two solves. For `fixed` see `solve`: with a fixed mesh
/// there is little of it, so that many warps share a multiprocessor.
template <class R, int fixed>
struct Memory {
  static constexpr int members = device::Access<R>::lanes;

  R* law;  ///< what `make_levy_measure` leaves, then the step table, and last a doubt that another warp reads
  R* slot;              ///< (9 most_lanes); with a fixed mesh what `domain_of` takes, or force
  R* w;                 ///< of a WeightLayout
  R* nodes;             ///< rows of `node_count`, and what the coarser solve has beyond its own, shorter ones
  NormalizedPut* puts;  ///< of the members, as the next
  SolutionAtSpot* answers;  ///< on the grid and on the coarser one
  double* unexercised;  ///< (members): values beside the spots on the coarser grid, without early exercise

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t bytes(int mesh) {
    const std::size_t all =
        sizeof(R) *
            static_cast<std::size_t>(law_size + slot_size + WeightLayout<R>(mesh).size() + node_size(mesh)) +
        members * (sizeof(NormalizedPut) + 2 * sizeof(SolutionAtSpot) + sizeof(double));
    return (all + 63) / 64 * 64;
  }
  KOKKOS_INLINE_FUNCTION Memory(void* place, int mesh)
      : law(static_cast<R*>(place)),
        slot(law + law_size),
        w(slot + slot_size),
        nodes(w + WeightLayout<R>(mesh).size()),
        puts(reinterpret_cast<NormalizedPut*>(nodes + node_size(mesh))),
        answers(reinterpret_cast<SolutionAtSpot*>(puts + members)),
        unexercised(reinterpret_cast<double*>(answers + 2 * members)) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* row(int k, int mesh) const { return nodes + k * node_count(mesh); }
  /// What is left at last where the law was.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION ErrorEstimate<R>* doubt() const {
    return reinterpret_cast<ErrorEstimate<R>*>(law);
  }
  /// The spectrum of the weights of a mesh that is transformed, in its two last rows; of the mesh that lanes
  /// keep it of in registers it only passes through.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION ComplexNumber<R>* spectrum(int mesh) const {
    return reinterpret_cast<ComplexNumber<R>*>(row(passes_through ? 1 : rows(mesh) - 2, mesh));
  }
  /// Weights of the coarser grid of a mesh, and every other value of the finer one, which does not reach into
  /// the rows 0 to 2 of the finer solve that are read last.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* coarse_weights(int mesh) const {
    return row(rows(mesh / 2), mesh / 2);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* kept(int mesh) const {
    return coarse_weights(mesh) + WeightLayout<R>(mesh / 2).size();
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION LevyMeasure<R> law_memory() const {
    return {
        law,   law + Mixture::size, law + 2 * Mixture::size, law + 2 * Mixture::size + Mixture::low, R(0.0),
        R(0.0)};
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* ratio() const { return law + 3 * Mixture::size; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* symbol() const { return law + StepFactors<R>::size * most_lanes; }

 private:
  static constexpr bool passes_through = fixed > 0 && keeps_spectrum(lanes_of(fixed));
  static constexpr int law_size = StepFactors<R>::size * most_lanes + symbols;
  static constexpr int slot_size = fixed == 0               ? 9 * most_lanes
                                   : fixed < 3 * most_lanes ? 3 * most_lanes
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

/// Where more of a solve's first member is left than its answer, in the memory of the backend; or nowhere.
struct Record {
  double* time = nullptr;  ///< (steps): to expiry, years
  double* boundary;        ///< (steps): x at these times
  double* x;               ///< (mesh + 1): nodes, at maturity
  double* value;           ///< (mesh + 1)
};

/// Marches with the nodes in the memory, whose rows 0 to 8 it takes. Not inlined: of a kernel that both
/// solves' code makes too large a GPU's compiler makes calls elsewhere.
template <class ThreadGroup, class R>
[[gnu::noinline]] KOKKOS_FUNCTION March<R> march_in_memory(const ThreadGroup& workers, const PutPack<R>& put,
                                                           const Jumps<R>& jumps, const Grid<R>& grid,
                                                           const JumpSpectrum<R>& spectrum,
                                                           const Scheme<R>& scheme, const StepTable<R>& table,
                                                           const Memory<R, 0>& memory, R kink,
                                                           const Record& record) {
  const int mesh = grid.mesh, count = node_count(mesh), steps = scheme.steps;
  const R h = grid.h;
  March<R> march{{memory.row(0, mesh), memory.row(1, mesh), memory.row(2, mesh)},
                 {memory.row(3, mesh), memory.row(4, mesh)},
                 memory.row(5, mesh),
                 memory.row(6, mesh),
                 memory.row(7, mesh),
                 memory.row(8, mesh),
                 memory.slot};
  workers.each([=](int thread) {
    for (int k = thread; k < 9 * count; k += workers.threads()) memory.nodes[k] = 0.0;
  });
  workers.each([=, &put](int thread) {
    for (int i = thread; i < mesh; i += workers.threads()) {
      const AtExpiry<R> node = at_expiry(put, grid, i, kink);
      march.value[1][i] = node.value;
      march.floor[i] = node.floor;
    }
  });
  Certain<R> begun{R(1.0), R(1.0)};
  for (int n = 1; n <= steps; ++n) {
    if (n % most_lanes == 1) fill_table(workers, put, jumps, scheme, table, n);
    const StepFactors<R> factors = table.load(n);
    step(workers, put, jumps, grid, spectrum, march, factors, begun);
    begun = factors.certain;
    if (record.time != nullptr) {
      workers.each([=, &put](int lane) {
        if (lane != 0) return;
        const auto strike = static_cast<int>(device::Access<R>::lane(grid.strike, 0));
        const double width = device::Access<R>::lane(h, 0);
        const Column values{reinterpret_cast<const double*>(march.value[0]), device::Access<R>::lanes};
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
  // After the rotation value[0] is what value[2] was.
  const StepLength<R> last = step_length(put.maturity, steps, steps);
  workers.each([=](int thread) {
    for (int i = thread; i <= mesh;
         i += workers.threads())  // the upper end too, where transforms leave numbers
      march.y[i] = rate_of_change(last, march.value[1][i], march.value[2][i], march.value[0][i]);
  });
  if (record.time != nullptr) {
    workers.each([=](int thread) {
      for (int i = thread; i <= mesh; i += workers.threads()) {
        record.x[i] = device::Access<R>::lane((double(i) - grid.strike) * h, 0);
        record.value[i] = device::Access<R>::lane(march.value[1][i], 0);
      }
    });
  }
  return march;
}

/// What a march leaves on the nodes of a pack, in the memory until the next one.
template <class R>
struct Solution {
  const R *value, *change;  ///< V and dV/dtau at maturity
  int exercised;            ///< last node below the strike that is, where lanes marched in registers
};

template <class R>
KOKKOS_INLINE_FUNCTION Column column_of(const R* nodes, int member) {
  return {reinterpret_cast<const double*>(nodes) + member, device::Access<R>::lanes};
}

/// Where the nodes of member k lie.
template <int fixed, class R>
KOKKOS_INLINE_FUNCTION Nodes nodes_of(const Solution<R>& solution, const NormalizedPut& put,
                                      const Grid<R>& grid, int k) {
  const auto member = [k](const R& number) { return device::Access<R>::lane(number, k); };
  const Column values = column_of(solution.value, k);
  const int strike = static_cast<int>(member(grid.strike));
  const double h = member(grid.h);
  const int last = fixed > 0 ? solution.exercised : put.early ? last_exercised(values, strike, h) : -1;
  return {grid.mesh, strike, last, h};
}

/// The jumps on `grid`, their weights in `weights`; if given from those of a grid of half the steps. For
/// `fixed` see `march_nodes`.
template <int fixed, class ThreadGroup, class R, class Scratch>
KOKKOS_INLINE_FUNCTION Jumps<R> jumps_on(const ThreadGroup& workers, const PutPack<R>& put,
                                         const LevyMeasure<R>& law, const Tails<R>& tails,
                                         const Grid<R>& grid, const Scratch& memory, R* weights,
                                         const R* finer = nullptr) {
  const int mesh = mesh_for<fixed>(grid.mesh);
  constexpr int left = fixed > 0 ? 3 : 9;
  return jumps_of(
      workers, put, law, tails, grid,
      {weights, memory.row(left, mesh), memory.row(left + 1, mesh), memory.symbol(), memory.row(1, mesh),
       memory.row(2, mesh), memory.row(0, mesh), memory.ratio(), memory.slot},
      finer);
}

/// The variance by which differences spread the payoff until maturity.
template <class R>
KOKKOS_INLINE_FUNCTION R spread_of(const PutPack<R>& put, const Jumps<R>& jumps) {
  return 2.0 * jumps.diffusion * put.maturity;
}

/// What is in doubt of a solve on `grid`, which another one on the coarser grid is compared with.
template <class R>
KOKKOS_INLINE_FUNCTION ErrorEstimate<R> doubt_of_solve(const PutPack<R>& put, const LevyMeasure<R>& law,
                                                       const Jumps<R>& jumps, const Grid<R>& grid,
                                                       int steps) {
  ErrorEstimate<R> doubt = doubt_of(put, law, grid.h, steps, spread_of(put, jumps));
  doubt.gap += doubt_of_stiff_jumps(put, law, jumps, steps, grid.h);
  if (put.model == Model::merton || put.model == Model::kou)
    doubt.factor = device::maximum(doubt.factor, factor_of_many_jumps(put, law, jumps, steps));
  return doubt;
}

/// Marches from expiry to the puts' maturities on `grid`. With a `fixed` > 0 that is the mesh and a group of
/// lanes keeps its nodes in registers; then nothing is recorded.
template <int fixed, class ThreadGroup, class R, class Scratch>
KOKKOS_INLINE_FUNCTION Solution<R> march_nodes(const ThreadGroup& workers, const PutPack<R>& put,
                                               const Jumps<R>& jumps, const Grid<R>& grid, int steps,
                                               const Scratch& memory, const FourierRoots& roots,
                                               const Record& record = {}) {
  const int mesh = mesh_for<fixed>(grid.mesh);
  // The kink of the payoff, as far as it gets smoothed out: h/12 is what the rule of trapezoids, which sums
  // over nodes amount to, lacks there.
  const R spread = spread_of(put, jumps);
  const R kink = grid.h * (1.0 / 12) * spread / (spread + grid.h * grid.h);
  const Scheme<R> scheme = scheme_of(put, jumps, grid, steps);
  const StepTable<R> table{memory.law};
  JumpSpectrum<R> spectrum{};
  if (is_transformed(mesh, workers.lanes))
    spectrum = spectrum_of(workers, mesh, roots, jumps.w, memory.spectrum(mesh));
  if constexpr (fixed > 0) {
    const RegisterRows rows{memory.row(0, mesh), memory.row(1, mesh), memory.row(2, mesh), memory.slot};
    const auto march = [&]<int block, bool halved>(const auto& threads) -> Solution<R> {
      return {
          rows.value, rows.other,
          march_in_registers<block, halved>(threads, put, jumps, grid, spectrum, scheme, table, rows, kink)};
    };
    if constexpr (ThreadGroup::is_alone && fixed == 8 * ThreadGroup::lanes)
      return march.template operator()<fixed / most_lanes, true>(WarpWorkers<>(workers.thread));
    else
      return march.template operator()<fixed / ThreadGroup::lanes, false>(workers);
  } else {
    const March<R> march =
        march_in_memory(workers, put, jumps, grid, spectrum, scheme, table, memory, kink, record);
    return {march.value[1], march.y, -1};
  }
}

/// `march_nodes`; `answers` gets one for each member.
template <int fixed, class ThreadGroup, class R, class Scratch>
KOKKOS_INLINE_FUNCTION Solution<R> solve(const ThreadGroup& workers, const PutPack<R>& put,
                                         const Jumps<R>& jumps, const Grid<R>& grid, int steps,
                                         const Scratch& memory, const FourierRoots& roots,
                                         SolutionAtSpot* answers, const Record& record = {}) {
  constexpr int members = device::Access<R>::lanes;
  const Solution<R> solution = march_nodes<fixed>(workers, put, jumps, grid, steps, memory, roots, record);
  workers.each([=](int thread) {
    for (int k = thread; k < members; k += workers.threads()) {
      answers[k] = answer_of(memory.puts[k], column_of(solution.value, k), column_of(solution.change, k),
                             nodes_of<fixed>(solution, memory.puts[k], grid, k));
    }
  });
  return solution;
}

}  // namespace drogue::options
