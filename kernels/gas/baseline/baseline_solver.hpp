#pragma once

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <vector>

#include "kernels/device/instance.hpp"
#include "kernels/device/pinned_memory.hpp"
#include "kernels/device/stopwatch.hpp"
#include "kernels/gas/gas_solver.hpp"
#include "kernels/gas/host_threads.hpp"
#include "kernels/gas/solver.hpp"
#include "kernels/gas/tile/tile_update.hpp"

namespace drogue::gas {

/// Flux kernel of [Shi], listing 4.3: a team loads its cells into shared memory and writes the fluxes of its
/// faces.
template <class ExecutionSpace>
struct BaselineFluxFunctor {
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

  FieldsView<ExecutionSpace> state;  ///< (cells, 3)
  FieldsView<ExecutionSpace> flux;   ///< (cells + 1, 3)
  TileShape shape;
  BoundaryConditions boundaries;
  double gamma;
  WaveSpeeds<double> alpha;  ///< maximum wave speeds over the mesh, m/s

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    using Lanes = device::Access<R>;
    const Tile<ExecutionSpace> tile(member, shape, boundaries.cells, cell_rows);
    load_cells<R, false>(member, tile, gamma,
                         [&](std::int64_t cell) { return load_state<R>(state.data(), boundaries, cell); });
    member.team_barrier();
    const WaveSpeeds<R> wave_speeds{R(alpha.slow), R(alpha.entropy), R(alpha.fast)};
    // The right one of two neighbouring tiles computes their common face.
    const int faces = tile.last ? tile.cells + 1 : tile.cells;
    for (int face = member.team_rank() * Lanes::lanes; face < faces;
         face += member.team_size() * Lanes::lanes) {
      const ConservedVector<R> f = face_flux<Reconstruction::js, R>(
          tile, face, load_stencil<R>(tile, face), FaceAverage::conserved, gamma, wave_speeds);
      for (int lane = 0; lane < Lanes::lanes && face + lane < faces; ++lane) {
        const std::int64_t at = tile.first + face + lane;
        flux(at, 0) = Lanes::lane(f.rho, lane);
        flux(at, 1) = Lanes::lane(f.m, lane);
        flux(at, 2) = Lanes::lane(f.energy, lane);
      }
    }
  }
};

/// Solver of [Shi], section 4.4.2: each stage copies the state to the device and the fluxes back, and the
/// host updates the state. There is one copy per field, because each field is an array of its own there, and
/// alpha is a kernel argument.
template <class ExecutionSpace>
class BaselineSolver final : public Solver {
 public:
  explicit BaselineSolver(const Parameters& p)
      : _instance(host_threads(p)),
        _p(p),
        _cells(static_cast<std::size_t>(p.cells)),
        _dx((p.x_max - p.x_min) / static_cast<double>(p.cells)),
        _state(host_fields(_cells)),
        _flux(host_fields(_cells + 1)),
        _device_state("drogue::gas::baseline_state", _cells),
        _device_flux("drogue::gas::baseline_flux", _cells + 1) {}

  void upload(std::int64_t first, const ConstConservedFields& f) override {
    const std::span<const double> part[3] = {f.rho, f.momentum, f.energy};
    for (std::size_t k = 0; k < 3; ++k) std::copy(part[k].begin(), part[k].end(), _state[k].begin() + first);
  }
  void download(std::int64_t first, const ConservedFields& f) override {
    const std::span<double> part[3] = {f.rho, f.momentum, f.energy};
    for (std::size_t k = 0; k < 3; ++k)
      std::copy_n(_state[k].begin() + first, part[k].size(), part[k].begin());
  }
  void start() override { _progress = {}; }
  void restore(const RestartState& state) override { _progress = state; }

  Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
               const Poll& poll) override {
    while (_progress.time < target) {
      if (_progress.step >= _p.max_steps) return Stop::max_steps;
      if (!step(target)) return Stop::failed;
      if (rows && row_every > 0 && _progress.step % row_every == 0) rows(totals());
      if (poll && !poll({.launches = 0,
                         .step = _progress.step,
                         .time = _progress.time,
                         .dt = _progress.last_dt,
                         .variant = 0,
                         .stop = Stop::running,
                         .outputs = 0}))
        return Stop::interrupted;
      if (_progress.step == pause_step) return Stop::pause;
    }
    return Stop::target;
  }

  HistoryRow totals() override {
    HistoryRow row;
    row.time = _progress.time;
    row.step = _progress.step;
    row.dt = _progress.last_dt;
    double* sums[3] = {&row.mass, &row.momentum, &row.energy};
    for (std::size_t k = 0; k < 3; ++k) {
      double compensation = 0.0;
      for (const double value : _state[k]) add_compensated(*sums[k], compensation, value * _dx);
      row.boundary[k] = _progress.boundary[1][k] - _progress.boundary[0][k];
    }
    row.max_speed = fastest()[3];
    return row;
  }

  RestartState restart_state() override { return _progress; }
  StepFailure failure() override { return _failure; }
  std::int64_t limited_cells() override { return 0; }
  void download_limited_cells(std::int64_t, std::span<std::uint8_t>) override {}
  void upload_limited_cells(std::int64_t, std::span<const std::uint8_t>) override {}
  void begin_snapshot() override { _snapshot = _state; }
  ConstConservedFields finish_snapshot() override { return {_snapshot[0], _snapshot[1], _snapshot[2]}; }
  [[nodiscard]] PhaseTimes phase_times() const override { return _phase_times; }
  [[nodiscard]] const char* driver() const override { return "seed"; }

 private:
  using State = std::array<std::pmr::vector<double>, 3>;

  /// Three fields of `n` zeros, in page-locked memory if requested.
  State host_fields(std::size_t n) {
    std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
    if (_p.pinned) memory = &_pinned;
    const auto zeros = [&] { return std::pmr::vector<double>(n, memory); };
    return {zeros(), zeros(), zeros()};
  }

  /// max |u-c|, |u|, |u+c|, |u|+c of the host state, m/s.
  std::array<double, 4> fastest() const {
    std::array<double, 4> fastest_speeds{};
    for (std::size_t i = 0; i < _cells; ++i) {
      const auto s = cell_state<double>(_p.gamma, _state[0][i], _state[1][i], _state[2][i]);
      fastest_speeds = {
          std::max(fastest_speeds[0], std::abs(s.u - s.c)), std::max(fastest_speeds[1], std::abs(s.u)),
          std::max(fastest_speeds[2], std::abs(s.u + s.c)), std::max(fastest_speeds[3], std::abs(s.u) + s.c)};
    }
    return fastest_speeds;
  }

  /// Replaces `_flux` by the fluxes of `_state`. `fastest_speeds` are the maximum wave speeds of `_state`,
  /// m/s.
  void fluxes(const std::array<double, 4>& fastest_speeds) {
    const auto timed = [](double& total, auto&& work) {
      const device::Stopwatch stopwatch;
      work();
      total += stopwatch.seconds();
    };
    const ExecutionSpace& space = _instance.space();
    timed(_phase_times.h2d, [&] {
      for (int k = 0; k < 3; ++k)
        copy_range(space, field(_device_state, k), 0,
                   std::span<const double>(_state[static_cast<std::size_t>(k)]), true);
    });
    timed(_phase_times.compute, [&] { launch({fastest_speeds[0], fastest_speeds[1], fastest_speeds[2]}); });
    timed(_phase_times.d2h, [&] {
      for (int k = 0; k < 3; ++k)
        copy_range(space, field(_device_flux, k), 0, std::span<double>(_flux[static_cast<std::size_t>(k)]),
                   false);
    });
  }

  /// Computes the fluxes on the device and blocks. One kernel serves all team sizes, so that timings differ
  /// only by team size.
  void launch(const WaveSpeeds<double>& alpha) {
    using Tiles = Tile<ExecutionSpace>;
    using Policy = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<largest_team, largest_teams>>;
    const ExecutionSpace& space = _instance.space();
    const int team = device_team(_p.block, _p.cells);
    const TileShape shape =
        tile_shape<ExecutionSpace>(_p.block, ghost_cells, fitting_slots(cell_rows, team, team));
    Policy policy(space, static_cast<int>((_p.cells + shape.cells - 1) / shape.cells),
                  device::is_host<ExecutionSpace> ? 1 : team);
    policy.set_scratch_size(
        0, Kokkos::PerTeam(static_cast<int>(Tiles::scratch_bytes(shape, cell_rows)) + scratch_margin));
    Kokkos::parallel_for("drogue::gas::baseline_flux", policy,
                         BaselineFluxFunctor<ExecutionSpace>{.state = _device_state,
                                                             .flux = _device_flux,
                                                             .shape = shape,
                                                             .boundaries = {_p.cells, _p.left, _p.right},
                                                             .gamma = _p.gamma,
                                                             .alpha = alpha});
    space.fence("drogue::gas::baseline_flux");
  }

  /// Takes one step. Returns false, sets `_failure` and restores the previous state if the new state is
  /// inadmissible.
  bool step(double target) {
    const double ramp = _progress.step < _p.ramp_steps ? 0.1 + 0.9 * static_cast<double>(_progress.step) /
                                                                   static_cast<double>(_p.ramp_steps)
                                                       : 1.0;
    std::array<double, 4> fastest_speeds = fastest();
    double dt = _p.fixed_dt > 0.0 ? _p.fixed_dt : ramp * _p.cfl * _dx / fastest_speeds[3];
    const bool reaches_target = dt >= (target - _progress.time) * (1.0 - 1e-12);
    if (reaches_target) dt = target - _progress.time;
    if (!(_progress.time + dt > _progress.time)) {
      _failure = {.reason = FailureReason::time_step,
                  .index = -1,
                  .step = _progress.step + 1,
                  .time = _progress.time,
                  .dt = dt};
      return false;
    }
    _start = _state;
    double boundary[2][3] = {};
    const StageTable table = stage_table(TimeScheme::ssprk3);
    for (int stage = 0; stage < table.stages; ++stage) {
      const StageWeights& w = table.stage[stage];
      if (stage > 0) fastest_speeds = fastest();
      fluxes(fastest_speeds);
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < _cells; ++i)
          _state[k][i] = _start[k][i] +
                         w.share * (_state[k][i] + dt / _dx * (_flux[k][i] - _flux[k][i + 1]) - _start[k][i]);
        boundary[0][k] += w.boundary * _flux[k].front();
        boundary[1][k] += w.boundary * _flux[k].back();
      }
      if (!admissible(dt)) {
        _state = _start;
        return false;
      }
    }
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k)
        add_compensated(_progress.boundary[side][k], _progress.compensation[side][k], dt * boundary[side][k]);
    _progress.dt_min = _progress.step == 0 ? dt : std::min(dt, _progress.dt_min);
    _progress.dt_max = std::max(dt, _progress.dt_max);
    _progress.last_dt = dt;
    _progress.time = reaches_target ? target : _progress.time + dt;
    ++_progress.step;
    return true;
  }

  bool admissible(double dt) {
    for (std::size_t i = 0; i < _cells; ++i) {
      const double rho = _state[0][i], m = _state[1][i];
      const double p = pressure(_p.gamma, m, _state[2][i], m / rho);
      if (rho > 0.0 && p > 0.0 && std::isfinite(p)) continue;
      const FailureReason what = rho <= 0.0 ? FailureReason::density
                                 : p <= 0.0 ? FailureReason::pressure
                                            : FailureReason::not_finite;
      _failure = {.reason = what,
                  .index = static_cast<std::int64_t>(i),
                  .step = _progress.step + 1,
                  .time = _progress.time,
                  .dt = dt};
      return false;
    }
    return true;
  }

  device::Instance<ExecutionSpace> _instance;
  device::PinnedMemory<ExecutionSpace> _pinned;
  Parameters _p;
  std::size_t _cells;
  double _dx;
  State _state, _flux;
  State _start, _snapshot;  ///< state before the step, and the snapshot
  FieldsView<ExecutionSpace> _device_state, _device_flux;
  RestartState _progress;
  StepFailure _failure;
  PhaseTimes _phase_times;
};

}  // namespace drogue::gas
