#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory_resource>
#include <vector>

#include "kernels/device/instance.hpp"
#include "kernels/device/pinned_memory.hpp"
#include "kernels/gas/solver.hpp"
#include "kernels/gas/solver_on.hpp"
#include "kernels/gas/tile_update.hpp"

namespace drogue::gas {

/// The dissertation's flux kernel (listing 4.3): a block stages its cells in shared memory and writes the
/// fluxes of its faces.
template <class ExecutionSpace>
struct SeedFluxFunctor {
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

  FieldsView<ExecutionSpace> state;  ///< (cells, 3)
  FieldsView<ExecutionSpace> flux;   ///< (cells + 1, 3)
  TileShape shape;
  Ends ends;
  double gamma;
  Speeds<double> alpha;  ///< the fastest signals of the mesh

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    using Lanes = device::Access<R>;
    const Tile<ExecutionSpace> tile(member, shape, ends.cells, cell_rows);
    load_cells<R, false>(member, tile, gamma,
                         [&](std::int64_t cell) { return load_state<R>(state.data(), ends, cell); });
    member.team_barrier();
    const Speeds<R> speeds{R(alpha.slow), R(alpha.entropy), R(alpha.fast)};
    // A face between two tiles is the right one's.
    const int faces = tile.last ? tile.cells + 1 : tile.cells;
    for (int face = member.team_rank() * Lanes::lanes; face < faces;
         face += member.team_size() * Lanes::lanes) {
      const Triple<R> f = face_flux<Reconstruction::js, R>(tile, face, load_stencil<R>(tile, face),
                                                           Mean::conserved, gamma, speeds);
      for (int lane = 0; lane < Lanes::lanes && face + lane < faces; ++lane) {
        const std::int64_t at = tile.first + face + lane;
        flux(at, 0) = Lanes::lane(f.rho, lane);
        flux(at, 1) = Lanes::lane(f.m, lane);
        flux(at, 2) = Lanes::lane(f.energy, lane);
      }
    }
  }
};

/// Section 4.4.2 of the dissertation: state up, fluxes down, update on the host, at every stage; one copy a
/// field, as each is an array of its own there, and alpha as an argument of the kernel.
template <class ExecutionSpace>
class SeedSolver final : public Solver {
 public:
  explicit SeedSolver(const Parameters& p)
      : _instance(useful_threads(p.cells)),
        _p(p),
        _cells(static_cast<std::size_t>(p.cells)),
        _dx((p.x_max - p.x_min) / static_cast<double>(p.cells)),
        _state(host_fields(_cells)),
        _flux(host_fields(_cells + 1)),
        _device_state("drogue::gas::seed_state", _cells),
        _device_flux("drogue::gas::seed_flux", _cells + 1) {}

  void upload(std::int64_t first, const ConstConserved& f) override {
    const std::span<const double> part[3] = {f.rho, f.momentum, f.energy};
    for (std::size_t k = 0; k < 3; ++k) std::copy(part[k].begin(), part[k].end(), _state[k].begin() + first);
  }
  void download(std::int64_t first, const Conserved& f) override {
    const std::span<double> part[3] = {f.rho, f.momentum, f.energy};
    for (std::size_t k = 0; k < 3; ++k)
      std::copy_n(_state[k].begin() + first, part[k].size(), part[k].begin());
  }
  void start() override { _resume = {}; }
  void restore(const Resume& state) override { _resume = state; }

  Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
               const Poll& poll) override {
    while (_resume.time < target) {
      if (_resume.step >= _p.max_steps) return Stop::max_steps;
      if (!step(target)) return Stop::failed;
      if (rows && row_every > 0 && _resume.step % row_every == 0) rows(totals());
      if (poll && !poll({0, _resume.step, _resume.time, _resume.last_dt, 0, Stop::running, 0}))
        return Stop::interrupted;
      if (_resume.step == pause_step) return Stop::pause;
    }
    return Stop::target;
  }

  HistoryRow totals() override {
    HistoryRow row;
    row.time = _resume.time;
    row.step = _resume.step;
    row.dt = _resume.last_dt;
    double* sums[3] = {&row.mass, &row.momentum, &row.energy};
    for (std::size_t k = 0; k < 3; ++k) {
      double compensation = 0.0;
      for (const double value : _state[k]) add_compensated(*sums[k], compensation, value * _dx);
      row.boundary[k] = _resume.boundary[1][k] - _resume.boundary[0][k];
    }
    row.max_speed = fastest()[3];
    return row;
  }

  Resume resume_state() override { return _resume; }
  Failed failure() override { return _failed; }
  std::int64_t touched_cells() override { return 0; }
  void download_touched(std::int64_t, std::span<std::uint8_t>) override {}
  void upload_touched(std::int64_t, std::span<const std::uint8_t>) override {}
  void begin_snapshot() override { _snapshot = _state; }
  ConstConserved finish_snapshot() override { return {_snapshot[0], _snapshot[1], _snapshot[2]}; }
  [[nodiscard]] Phases phases() const override { return _phases; }
  [[nodiscard]] const char* driver() const override { return "seed"; }

 private:
  using State = std::array<std::pmr::vector<double>, 3>;

  /// Three fields of `n` zeros, where the copies to and from the device find them.
  State host_fields(std::size_t n) {
    std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
    if (_p.pinned) memory = &_pinned;
    const auto zeros = [&] { return std::pmr::vector<double>(n, memory); };
    return {zeros(), zeros(), zeros()};
  }

  /// max |u-c|, |u|, |u+c|, |u|+c of the host's state.
  std::array<double, 4> fastest() const {
    std::array<double, 4> most{};
    for (std::size_t i = 0; i < _cells; ++i) {
      const auto s = cell_state<double>(_p.gamma, _state[0][i], _state[1][i], _state[2][i]);
      most = {std::max(most[0], std::abs(s.u - s.c)), std::max(most[1], std::abs(s.u)),
              std::max(most[2], std::abs(s.u + s.c)), std::max(most[3], std::abs(s.u) + s.c)};
    }
    return most;
  }

  /// Replaces `_flux` by the fluxes of `_state`, whose fastest signals are `most`.
  void fluxes(const std::array<double, 4>& most) {
    const auto timed = [](double& total, auto&& work) {
      const auto begin = std::chrono::steady_clock::now();
      work();
      total += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const ExecutionSpace& space = _instance.space();
    timed(_phases.h2d, [&] {
      for (int k = 0; k < 3; ++k)
        copy_range(space, field(_device_state, k), 0,
                   std::span<const double>(_state[static_cast<std::size_t>(k)]), true);
    });
    timed(_phases.compute, [&] { launch({most[0], most[1], most[2]}); });
    timed(_phases.d2h, [&] {
      for (int k = 0; k < 3; ++k)
        copy_range(space, field(_device_flux, k), 0, std::span<double>(_flux[static_cast<std::size_t>(k)]),
                   false);
    });
  }

  /// Computes the fluxes on the device and waits. One kernel for all sizes of a block, so that they differ in
  /// nothing else.
  void launch(const Speeds<double>& alpha) {
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
    Kokkos::parallel_for(
        "drogue::gas::seed_flux", policy,
        SeedFluxFunctor<ExecutionSpace>{
            _device_state, _device_flux, shape, {_p.cells, _p.left, _p.right}, _p.gamma, alpha});
    space.fence("drogue::gas::seed_flux");
  }

  /// One step; false and `_failed` if it leaves an inadmissible state, with the state before it kept.
  bool step(double target) {
    const double ramp = _resume.step < _p.ramp_steps ? 0.1 + 0.9 * static_cast<double>(_resume.step) /
                                                                 static_cast<double>(_p.ramp_steps)
                                                     : 1.0;
    std::array<double, 4> most = fastest();
    double dt = _p.fixed_dt > 0.0 ? _p.fixed_dt : ramp * _p.cfl * _dx / most[3];
    const bool reaches = dt >= (target - _resume.time) * (1.0 - 1e-12);
    if (reaches) dt = target - _resume.time;
    if (!(_resume.time + dt > _resume.time)) {
      _failed = {Quantity::time_step, -1, _resume.step + 1, _resume.time, dt};
      return false;
    }
    _start = _state;
    double boundary[2][3] = {};
    const StageTable table = stage_table(TimeScheme::ssprk3);
    for (int stage = 0; stage < table.stages; ++stage) {
      const StageWeights& w = table.stage[stage];
      if (stage > 0) most = fastest();
      fluxes(most);
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
        add_compensated(_resume.boundary[side][k], _resume.compensation[side][k], dt * boundary[side][k]);
    _resume.dt_min = _resume.step == 0 ? dt : std::min(dt, _resume.dt_min);
    _resume.dt_max = std::max(dt, _resume.dt_max);
    _resume.last_dt = dt;
    _resume.time = reaches ? target : _resume.time + dt;
    ++_resume.step;
    return true;
  }

  bool admissible(double dt) {
    for (std::size_t i = 0; i < _cells; ++i) {
      const double rho = _state[0][i], m = _state[1][i];
      const double p = pressure(_p.gamma, m, _state[2][i], m / rho);
      if (rho > 0.0 && p > 0.0 && std::isfinite(p)) continue;
      const Quantity what = rho <= 0.0 ? Quantity::density
                            : p <= 0.0 ? Quantity::pressure
                                       : Quantity::not_finite;
      _failed = {what, static_cast<std::int64_t>(i), _resume.step + 1, _resume.time, dt};
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
  State _start, _snapshot;  ///< the state before the step, and one put aside
  FieldsView<ExecutionSpace> _device_state, _device_flux;
  Resume _resume;
  Failed _failed;
  Phases _phases;
};

template <class ExecutionSpace>
std::unique_ptr<Solver> make_seed_solver(const Parameters& parameters) {
  return std::make_unique<SeedSolver<ExecutionSpace>>(parameters);
}

}  // namespace drogue::gas
