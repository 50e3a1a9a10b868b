#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "kernels/device/backend.hpp"
#include "kernels/gas/parameters.hpp"
#include "kernels/gas/status.hpp"

namespace drogue::gas {

/// Conserved fields of consecutive cells on the host: kg/m^3, kg/(m^2 s), J/m^3.
struct ConservedFields {
  std::span<double> rho, momentum, energy;
};
struct ConstConservedFields {
  std::span<const double> rho, momentum, energy;
};

/// Decomposition of the mesh into tiles.
struct Tiling {
  std::int64_t cells = 0;  ///< cells that a tile updates
  int halo = 0;            ///< cells that a tile reads beyond them on either side
  bool fused = false;      ///< one kernel for all stages, otherwise one kernel per stage
};

/// Wall times of transfers and computation, s (columns of [Shi], table 5.5). Only the baseline solver
/// separates them.
struct PhaseTimes {
  double h2d = 0.0, compute = 0.0, d2h = 0.0;
};

using stepping::Poll;

/// Callback that receives every history row, in order.
using RowSink = std::function<void(const HistoryRow&)>;

/// Finite-volume solver whose state resides on a backend. Requires an initialised runtime.
///
/// Call `upload` for all cells, then `start` or `restore`, then `advance` as often as needed. Functions block
/// unless stated otherwise and are not thread-safe. A failed kernel throws `std::runtime_error`.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Sets the cells first .. first + fields.rho.size() - 1, in the units of `ConservedFields`. The range must
  /// lie within the mesh. Does not check the values.
  virtual void upload(std::int64_t first, const ConstConservedFields& fields) = 0;

  /// Reads a range of cells of the last accepted state, in the units of `ConservedFields`. The range must lie
  /// within the mesh.
  virtual void download(std::int64_t first, const ConservedFields& fields) = 0;

  /// Makes the uploaded fields the initial state at time 0 s and step 0.
  virtual void start() = 0;

  /// Continues from the uploaded fields with `state`, which came from `restart_state` of an equal solver.
  virtual void restore(const RestartState& state) = 0;

  /// Steps until the time reaches `target` (s), the number of steps equals `pause_step` (-1: no pause), or
  /// the run stops. Sends a row to `rows` whenever the number of steps is a multiple of `row_every` (0:
  /// never). `poll` may be empty. Reports failures by the returned `Stop` and does not throw for them.
  virtual Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
                       const Poll& poll) = 0;

  /// Sums over the current state, SI units per unit area.
  virtual HistoryRow totals() = 0;

  /// State of the step control for a restart file. Throws only after a failed kernel.
  [[nodiscard]] virtual RestartState restart_state() = 0;

  /// Failure that ended the last `advance` with `Stop::failed`. Throws only after a failed kernel.
  [[nodiscard]] virtual StepFailure failure() = 0;

  /// Number of cells beside a face that the limiter has changed since the start; 0 without a limiter.
  [[nodiscard]] virtual std::int64_t limited_cells() = 0;

  /// Reads or sets a range of the flags of cells beside a limited face: 1 or 0. The range must lie within the
  /// mesh. Requires a limiter, that is, a positivity other than `off`.
  virtual void download_limited_cells(std::int64_t first, std::span<std::uint8_t> cells) = 0;
  virtual void upload_limited_cells(std::int64_t first, std::span<const std::uint8_t> cells) = 0;

  /// Starts an asynchronous copy of the last accepted state. Later steps overlap with the copy. The copy
  /// stays valid until the next call.
  virtual void begin_snapshot() = 0;

  /// Waits for the copy and returns it. Any thread may call it.
  virtual ConstConservedFields finish_snapshot() = 0;

  /// Accumulated phase times, s; zero unless this is the baseline solver. Does not throw.
  [[nodiscard]] virtual PhaseTimes phase_times() const = 0;

  /// Launch strategy: "persistent", "graph", "plain", "stages" or "seed". Does not throw.
  [[nodiscard]] virtual const char* driver() const = 0;

  /// Tiling of a step without the limiter; all zero for the baseline solver. Does not throw.
  [[nodiscard]] virtual Tiling tiling() const { return {}; }
};

/// Creates a solver on `backend`, which must be available. Throws `std::invalid_argument` for parameters out
/// of range and `std::bad_alloc` if memory runs out.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters);

/// Creates the baseline solver, which reproduces the algorithm and data movement of [Shi], section 4.4.2.
/// Each stage copies the state to the device and the fluxes back; the host updates the state. The scheme is
/// fixed: JS weights, average of U, one alpha per field, SSP-RK3. Throws as `create_solver` does.
[[nodiscard]] std::unique_ptr<Solver> create_baseline_solver(device::Backend backend,
                                                             const Parameters& parameters);

}  // namespace drogue::gas
