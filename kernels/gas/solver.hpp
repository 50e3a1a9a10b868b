#pragma once

#include <functional>
#include <memory>
#include <span>

#include "kernels/device/backend.hpp"
#include "kernels/gas/parameters.hpp"
#include "kernels/gas/status.hpp"
#include "kernels/gas/work.hpp"

namespace drogue::gas {

/// Conserved fields of consecutive cells on the host, SI units.
struct Conserved {
  std::span<double> rho, momentum, energy;
};
struct ConstConserved {
  std::span<const double> rho, momentum, energy;
};

/// Wall time of the three columns of the dissertation's Table 5.5, s; only seed mode separates them.
struct Phases {
  double h2d = 0.0, compute = 0.0, d2h = 0.0;
};

/// Called a few times a second while stepping; false ends the stepping after the steps in flight.
using Poll = std::function<bool(const Status&)>;

/// Called for every row of the history, in order.
using RowSink = std::function<void(const HistoryRow&)>;

/// A gas state that lives on a backend and steps there. Needs an initialised runtime.
///
/// Life: `upload` all cells, `start` (or `restore`), then `advance` as often as wanted.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Sets cells first .. first + fields.rho.size() - 1 of the state that `download` reads.
  virtual void upload(std::int64_t first, const ConstConserved& fields) = 0;

  /// Reads cells of the last accepted state.
  virtual void download(std::int64_t first, const Conserved& fields) = 0;

  /// The uploaded state is the initial one.
  virtual void start() = 0;

  /// The uploaded state is one that `resume_state` and `download` gave.
  virtual void restore(const Resume& state) = 0;

  /// Steps until `target` (s), until `pause_step` steps are done, or until something stops it. A row goes to
  /// `rows` whenever the number of steps is a multiple of `row_every` (0: never).
  virtual Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
                       const Poll& poll) = 0;

  /// The totals now.
  virtual HistoryRow totals() = 0;

  [[nodiscard]] virtual Resume resume_state() = 0;
  [[nodiscard]] virtual Failed failure() = 0;

  /// Cells beside a face that the limiter has touched since the start.
  [[nodiscard]] virtual std::int64_t touched_cells() = 0;
  virtual void download_touched(std::int64_t first, std::span<std::uint8_t> cells) = 0;
  virtual void upload_touched(std::int64_t first, std::span<const std::uint8_t> cells) = 0;

  /// Copies the last accepted state aside, without stopping what follows; valid until the next call.
  virtual void begin_snapshot() = 0;

  /// Waits for the copy; any thread.
  virtual ConstConserved finish_snapshot() = 0;

  [[nodiscard]] virtual Phases phases() const = 0;

  /// How a step reaches the device: "persistent", "graph", "plain", "stages" or "seed".
  [[nodiscard]] virtual const char* driver() const = 0;

  /// Of a step in which the limiter has nothing to do; none in seed mode.
  [[nodiscard]] virtual Tiling tiling() const { return {}; }
};

/// Throws std::invalid_argument for parameters out of range and std::bad_alloc; the backend must be
/// available.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters);

/// The dissertation's algorithm and data movement (section 4.4.2): at every stage the state goes to the
/// device and the flux comes back, the host updates. JS weights, mean of U, one alpha per field, SSP-RK3.
[[nodiscard]] std::unique_ptr<Solver> create_seed_solver(device::Backend backend,
                                                         const Parameters& parameters);

}  // namespace drogue::gas
