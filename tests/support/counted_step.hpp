#pragma once

#include <vector>

#include "perf/models/gas_step.hpp"
#include "tests/support/counted.hpp"
#include "tests/support/gas_state.hpp"

// These headers must follow the definition of the counted type.
#include "kernels/gas/stepping/stage.hpp"
#include "kernels/gas/stepping/step.hpp"

namespace drogue::testing {

/// Runs the tiles of a small periodic mesh one by one with the functions of the kernels on numbers of type R.
/// Counts their operations and the bytes of the fields that they access.
template <class R>
class CountedStep {
 public:
  static constexpr double gamma = 1.4, dt_over_dx = 0.1;
  static constexpr int row = 64;
  static constexpr std::int64_t cells = 44, tile_cells = 18;  ///< the last tile is smaller
  static constexpr gas::BoundaryConditions boundaries{cells, gas::Boundary::periodic,
                                                      gas::Boundary::periodic};

  using Tile = gas::Tile<Kokkos::Serial>;
  template <gas::Reconstruction scheme>
  using Step = gas::StepFunctor<Kokkos::Serial, scheme, gas::Precision::full, false>;
  template <gas::Reconstruction scheme>
  using Stage = gas::StageFunctor<Kokkos::Serial, scheme, gas::Precision::full, false>;

  /// Only thread of a team, with its scratch memory.
  struct Thread {
    std::int64_t tile;
    double* scratch;

    [[nodiscard]] std::int64_t league_rank() const { return tile; }
    [[nodiscard]] static int team_rank() { return 0; }
    [[nodiscard]] static int team_size() { return 1; }
    [[nodiscard]] const Thread& team_scratch(int) const { return *this; }
    [[nodiscard]] void* get_shmem_aligned(std::size_t, std::size_t) const { return scratch; }
  };

  CountedStep(const gas::StageTable& table, unsigned seed) : _table(table) {
    gas::Parameters p;
    p.cells = cells;
    for (const auto& values : random_state(p, seed, rough))
      _fields[0].insert(_fields[0].end(), values.begin(), values.end());
    _fields[1] = _fields[2] = _fields[0];
  }

  perf::StepWork work;              ///< total of all runs
  std::int64_t times_combined = 0;  ///< number of combinations with U^n in `run_fused`

  /// U^{n+1} of `run_fused`, (cells, 3).
  [[nodiscard]] const std::vector<double>& result() const { return _fields[1]; }

  /// Runs the operations of `StepFunctor`.
  template <gas::Reconstruction scheme>
  void run_fused() {
    const Step<scheme> step = fused<scheme>();
    for_tiles(step.shape, [&](const Thread& thread, const Tile& tile) {
      load(thread, tile, 0);
      for (int stage = 0; stage < _table.stages; ++stage) {
        const auto faces = step.faces_of(tile, stage);
        for (int face = faces.first; face <= faces.last; ++face) compute_face<scheme>(tile, face);
        for (int i = faces.first + gas::ghost_cells; i < faces.last + gas::ghost_cells; ++i) {
          times_combined += _table.stage[stage].share != 1.0;
          if (stage < _table.stages - 1)
            update<false>(step, tile, i, stage);
          else
            update<true>(step, tile, i, stage);
        }
      }
    });
  }

  /// Runs the operations of `StageFunctor` in all stages of a step.
  template <gas::Reconstruction scheme>
  void run_stages() {
    const gas::TileShape shape{tile_cells, gas::ghost_cells, row};
    for (int k = 0; k < _table.stages; ++k) {
      const gas::StageWeights& weights = _table.stage[k];
      const Stage<scheme> stage{
          {}, {}, {}, weights, shape, boundaries, gamma, 1.0, k, gas::Splitting::lf_stencil, {}, true};
      for_tiles(shape, [&](const Thread& thread, const Tile& tile) {
        load(thread, tile, weights.in);
        for (int face = 0; face <= tile.cells; ++face) compute_face<scheme>(tile, face);
        gas::CellReduction<R> reduced;
        for (int i = tile.halo; i < tile.halo + tile.cells; ++i)
          stage.template update_cell<R>(tile, i, dt_over_dx, field(0), field(weights.out), reduced);
      });
    }
  }

  /// Calls `run(thread, tile)` for every tile.
  template <class Run>
  void for_tiles(const gas::TileShape& shape, const Run& run) {
    for (std::int64_t k = 0; k * shape.cells < cells; ++k) {
      trace.read.clear(), trace.written.clear();
      const Thread thread{k, _scratch.data()};
      run(thread, Tile(thread, shape, cells));
      work.bytes += bytes_touched();
    }
  }

  perf::Arithmetic load(const Thread& thread, const Tile& tile, int from) {
    return add([&] {
      gas::load_cells<R, false>(thread, tile, gamma, [&](std::int64_t cell) {
        return gas::load_state<R>(field(from), boundaries, cell);
      });
    });
  }

  template <gas::Reconstruction scheme>
  perf::Arithmetic compute_face(const Tile& tile, int face) {
    return add([&] {
      tile.store_flux(face, gas::face_flux<scheme, R>(tile, face, gas::load_stencil<R>(tile, face),
                                                      gas::FaceAverage::arithmetic, gamma,
                                                      gas::stencil_wave_speeds<R, R>(tile, face)));
    });
  }

  template <bool last, class Functor>
  perf::Arithmetic update(const Functor& step, const Tile& tile, int slot, int stage) {
    return add([&] {
      gas::CellReduction<R> reduced;
      step.template update_slot<last, R>(tile, slot, {slot, false}, _table.stage[stage], dt_over_dx, field(0),
                                         field(1), typename Functor::SingleStepHooks{}, reduced);
      // The fused step uses two of the maximum wave speeds.
      if constexpr (!std::is_same_v<R, double>)
        reduced.slow.keep(), reduced.fast.keep(), reduced.admissible.keep();
    });
  }

  template <gas::Reconstruction scheme>
  [[nodiscard]] Step<scheme> fused() const {
    return {{},         {},    {},  _table, {tile_cells, gas::ghost_cells * _table.stages, row},
            boundaries, gamma, 1.0, {}};
  }

 private:
  double* field(int buffer) { return _fields[buffer].data(); }

  template <class Evaluate>
  perf::Arithmetic add(const Evaluate& evaluate) {
    const perf::Arithmetic cost = arithmetic_of(evaluate);
    work.arithmetic = work.arithmetic + cost;
    return cost;
  }

  /// Bytes of the fields that were read and written, each value once.
  [[nodiscard]] std::int64_t bytes_touched() const {
    std::int64_t values = 0;
    for (const auto& f : _fields)
      for (const auto* addresses : {&trace.read, &trace.written})
        for (const double* address : *addresses) values += address >= &f.front() && address <= &f.back();
    return values * static_cast<std::int64_t>(sizeof(double));
  }

  gas::StageTable _table;
  std::vector<double> _fields[3];  ///< as the kernels access them; the first is U^n
  std::vector<double> _scratch = std::vector<double>(row * Tile::rows);
};

}  // namespace drogue::testing
