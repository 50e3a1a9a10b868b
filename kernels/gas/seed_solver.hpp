#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "kernels/device/instance.hpp"
#include "kernels/gas/solver.hpp"
#include "kernels/gas/solver_on.hpp"
#include "kernels/gas/stage.hpp"

namespace drogue::gas {

/// The dissertation's flux kernel: a block stages its cells in shared memory and writes the fluxes of its
/// faces.
template <class ExecutionSpace>
struct SeedFluxFunctor {
  using Stage = StageFunctor<ExecutionSpace, Reconstruction::js, Precision::full, false>;
  Stage stage;
  FieldsView<ExecutionSpace> flux;  ///< (cells + 1, 3)

  KOKKOS_FUNCTION void operator()(const typename Stage::Member& member) const {
    const Tile<ExecutionSpace> tile(member, stage.shape, stage.ends.cells);
    load_cells<typename Stage::R, false>(member, tile, stage.ends, stage.gamma, stage.buffer[0].data());
    member.team_barrier();
    stage.compute_fluxes(member, tile, 0.0);  // dt is the limiter's alone
    member.team_barrier();
    for (int face = member.team_rank(); face <= tile.cells; face += member.team_size()) {
      if (face == tile.cells && !tile.last) continue;
      const Triple<double> f = tile.template flux<double>(face);
      flux(tile.first + face, 0) = f.rho;
      flux(tile.first + face, 1) = f.m;
      flux(tile.first + face, 2) = f.energy;
    }
  }
};

/// Section 4.4.2 of the dissertation: state up, fluxes down, update on the host, at every stage.
template <class ExecutionSpace>
class SeedSolver final : public Solver {
 public:
  explicit SeedSolver(const Parameters& p)
      : _instance(useful_threads(p.cells)),
        _p(p),
        _cells(static_cast<std::size_t>(p.cells)),
        _dx((p.x_max - p.x_min) / static_cast<double>(p.cells)) {
    for (auto& state : _state)
      for (auto& values : state) values.resize(_cells);
    for (auto& values : _flux) values.resize(_cells + 1);
    for (int k = 0; k < 3; ++k)
      _stage.buffer[k] = FieldsView<ExecutionSpace>("drogue::gas::seed_state", k == 0 ? _cells : 0);
    _stage.control = decltype(_stage.control)("drogue::gas::seed_control");
    _stage.weights = stage_table(TimeScheme::ssprk3).stage[0];
    _stage.shape = tile_shape<ExecutionSpace>(p.block, ghost_cells, device_team(p.block, p.cells));
    _stage.ends = {p.cells, p.left, p.right};
    _stage.gamma = p.gamma;
    _stage.inverse_dx = 1.0 / _dx;
    _stage.stage = 0;
    _stage.splitting = Splitting::lf_global;
    _stage.mean = Mean::conserved;
    _stage.reduce_speed = false;
    _device_flux = FieldsView<ExecutionSpace>("drogue::gas::seed_flux", _cells + 1);
  }

  void upload(std::int64_t first, const ConstConserved& f) override {
    const std::span<const double> part[3] = {f.rho, f.momentum, f.energy};
    for (std::size_t k = 0; k < 3; ++k)
      std::copy(part[k].begin(), part[k].end(), _state[0][k].begin() + first);
  }
  void download(std::int64_t first, const Conserved& f) override {
    const std::span<double> part[3] = {f.rho, f.momentum, f.energy};
    for (std::size_t k = 0; k < 3; ++k)
      std::copy_n(_state[0][k].begin() + first, part[k].size(), part[k].begin());
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
      for (const double value : _state[0][k]) add_compensated(*sums[k], compensation, value * _dx);
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
  void begin_snapshot() override { _snapshot = _state[0]; }
  ConstConserved finish_snapshot() override { return {_snapshot[0], _snapshot[1], _snapshot[2]}; }
  [[nodiscard]] Phases phases() const override { return _phases; }
  [[nodiscard]] const char* driver() const override { return "seed"; }

 private:
  using State = std::array<std::vector<double>, 3>;

  /// max |u-c|, |u|, |u+c|, |u|+c of the host's state.
  std::array<double, 4> fastest() const {
    std::array<double, 4> most{};
    for (std::size_t i = 0; i < _cells; ++i) {
      const auto s = cell_state<double>(_p.gamma, _state[0][0][i], _state[0][1][i], _state[0][2][i]);
      most = {std::max(most[0], std::abs(s.u - s.c)), std::max(most[1], std::abs(s.u)),
              std::max(most[2], std::abs(s.u + s.c)), std::max(most[3], std::abs(s.u) + s.c)};
    }
    return most;
  }

  /// Replaces `_flux` by the fluxes of `_state[0]`.
  void fluxes() {
    const auto most = fastest();
    const auto timed = [](double& total, auto&& work) {
      const auto begin = std::chrono::steady_clock::now();
      work();
      total += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const ExecutionSpace& space = _instance.space();
    timed(_phases.h2d, [&] {
      auto control = Kokkos::create_mirror_view(_stage.control);
      for (int k = 0; k < 3; ++k)
        control().outcome.stage_speed[0][k] =
            Kokkos::bit_cast<std::uint64_t>(most[static_cast<std::size_t>(k)]);
      Kokkos::deep_copy(space, _stage.control, control);
      for (int k = 0; k < 3; ++k)
        copy_range(space, field(_stage.buffer[0], k), 0,
                   std::span<const double>(_state[0][static_cast<std::size_t>(k)]), true);
    });
    timed(_phases.compute, [&] {
      const auto tiles = static_cast<int>((_p.cells + _stage.shape.cells - 1) / _stage.shape.cells);
      Kokkos::TeamPolicy<ExecutionSpace> policy(
          space, tiles, device::is_host<ExecutionSpace> ? 1 : device_team(_p.block, _p.cells));
      policy.set_scratch_size(
          0, Kokkos::PerTeam(static_cast<int>(Tile<ExecutionSpace>::scratch_bytes(_stage.shape) + 64)));
      Kokkos::parallel_for("drogue::gas::seed_flux", policy,
                           SeedFluxFunctor<ExecutionSpace>{_stage, _device_flux});
      space.fence("drogue::gas::seed_flux");
    });
    timed(_phases.d2h, [&] {
      for (int k = 0; k < 3; ++k)
        copy_range(space, field(_device_flux, k), 0, std::span<double>(_flux[static_cast<std::size_t>(k)]),
                   false);
    });
  }

  /// One step; false and `_failed` if it leaves an inadmissible state, with the state before it kept.
  bool step(double target) {
    const double ramp = _resume.step < _p.ramp_steps ? 0.1 + 0.9 * static_cast<double>(_resume.step) /
                                                                 static_cast<double>(_p.ramp_steps)
                                                     : 1.0;
    double dt = _p.fixed_dt > 0.0 ? _p.fixed_dt : ramp * _p.cfl * _dx / fastest()[3];
    const bool reaches = dt >= (target - _resume.time) * (1.0 - 1e-12);
    if (reaches) dt = target - _resume.time;
    if (!(_resume.time + dt > _resume.time)) {
      _failed = {Quantity::time_step, -1, _resume.step + 1, _resume.time, dt};
      return false;
    }
    _state[1] = _state[0];
    double boundary[2][3] = {};
    const StageTable table = stage_table(TimeScheme::ssprk3);
    for (int stage = 0; stage < table.stages; ++stage) {
      const StageWeights& w = table.stage[stage];
      fluxes();
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < _cells; ++i)
          _state[0][k][i] = w.a_n * _state[1][k][i] +
                            w.a_in * (_state[0][k][i] + dt / _dx * (_flux[k][i] - _flux[k][i + 1]));
        boundary[0][k] += w.boundary * _flux[k].front();
        boundary[1][k] += w.boundary * _flux[k].back();
      }
      if (!admissible(dt)) {
        _state[0] = _state[1];
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
      const double rho = _state[0][0][i], m = _state[0][1][i];
      const double p = pressure(_p.gamma, m, _state[0][2][i], m / rho);
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
  Parameters _p;
  std::size_t _cells;
  double _dx;
  State _state[2], _flux, _snapshot;
  StageFunctor<ExecutionSpace, Reconstruction::js, Precision::full, false> _stage;
  FieldsView<ExecutionSpace> _device_flux;
  Resume _resume;
  Failed _failed;
  Phases _phases;
};

}  // namespace drogue::gas
