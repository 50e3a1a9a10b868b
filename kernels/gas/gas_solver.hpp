#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/relaxed_access.hpp"
#include "kernels/gas/solver.hpp"
#include "kernels/gas/stepping/history.hpp"
#include "kernels/gas/stepping/launch.hpp"
#include "kernels/gas/transfer.hpp"
#include "kernels/stepping/step_launcher.hpp"
#include "kernels/stepping/step_loop.hpp"

namespace drogue::gas {

/// Gas solver on the caller's instance of an execution space. It owns three field buffers, a device-resident
/// control block and two captured steps, with and without the flux limiter; the control block decides which
/// of the two has an effect.
///
/// All work is enqueued on the instance, which must outlive the solver; on CUDA it must have a stream of its
/// own. Final functions are documented in `Solver`.
template <class ExecutionSpace>
class GasSolver : public Solver {
 public:
  /// Throws std::runtime_error if memory runs out.
  GasSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& parameters);

  void upload(std::int64_t first, const ConstConservedFields& fields) final;
  void download(std::int64_t first, const ConservedFields& fields) final;
  void start() final;
  void restore(const RestartState& state) final;
  Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
               const Poll& poll) final;
  HistoryRow totals() final;
  RestartState restart_state() final { return read_control().restart; }
  StepFailure failure() final { return read_control().failure; }
  std::int64_t limited_cells() final;
  void download_limited_cells(std::int64_t first, std::span<std::uint8_t> cells) final;
  void upload_limited_cells(std::int64_t first, std::span<const std::uint8_t> cells) final;
  void begin_snapshot() final;
  ConstConservedFields finish_snapshot() final;
  [[nodiscard]] PhaseTimes phase_times() const final { return {}; }
  [[nodiscard]] const char* driver() const final;
  [[nodiscard]] Tiling tiling() const final;

 private:
  using Memory = typename ExecutionSpace::memory_space;
  using Pinned = device::HostPinnedSpace<ExecutionSpace>;
  using Fields = FieldsView<ExecutionSpace>;
  using HostFields = Kokkos::View<double* [3], Kokkos::LayoutLeft, Pinned>;
  static constexpr bool on_host = device::is_host<ExecutionSpace>;

  [[nodiscard]] Control read_control() const;
  void write_control(const Control& control);
  void initialise_control(Control& control);
  /// True if all stages of a step run in one kernel.
  [[nodiscard]] bool is_fused() const {
    return _setup.splitting == Splitting::lf_stencil && _launcher.driver() != Driver::stages;
  }
  void enqueue_step(const ExecutionSpace& space, bool limited) const;
  void enqueue_sums(const ExecutionSpace& space, int row_every, bool always) const;
  void make_persistent();
  void read_rows(const RowSink& rows);
  struct DeviceSteps;

  const device::Instance<ExecutionSpace>& _instance;
  device::Instance<ExecutionSpace> _copy_instance;
  Parameters _parameters;
  StepConstants _constants;
  StageSetup<ExecutionSpace> _setup;
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace, 2> _launcher;  ///< variant 1: with the flux limiter
  Kokkos::View<HistoryRow*, Pinned> _ring;
  std::array<Fields, 4> _partial;  ///< partial sums after each level
  std::unique_ptr<device::CapturedGraph<ExecutionSpace>> _row;
  std::optional<PersistentSetup<ExecutionSpace>> _persistent;
  int _row_every = 0;
  Fields _snapshot;
  HostFields _host_snapshot;
  std::int64_t _rows_read = 0;
  std::optional<HistoryRow> _last_row;
};

/// Tile shape. On a device the slots of a tile, halo included, are a multiple of its threads or as many as
/// fit in shared memory. On a host the scratch of a tile stays in the L1 cache. Does not throw.
template <class ExecutionSpace>
TileShape tile_shape(int block, int halo, int slots) {
  if constexpr (device::is_host<ExecutionSpace>) {
    const int cells = block > 0 ? block : 256;
    return {cells, halo, (cells + 2 * halo + 2 * device::host_lanes + 7) / 8 * 8};
  } else {
    return {slots - 2 * halo, halo, slots};
  }
}

template <class ExecutionSpace>
GasSolver<ExecutionSpace>::GasSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& p)
    : _instance(instance),
      _copy_instance(1),
      _parameters(p),
      _loop(_instance),
      _launcher(_instance, p.driver) {
  const double dx = (p.x_max - p.x_min) / static_cast<double>(p.cells);
  _setup.table = stage_table(p.time_scheme);
  const double limited_cap = p.time_scheme == TimeScheme::ssprk3 ? 0.4 : 0.8;
  _constants = {.gamma = p.gamma,
                .dx = dx,
                .cfl = p.cfl,
                .limited_cfl = p.cfl < limited_cap ? p.cfl : limited_cap,
                .fixed_dt = p.fixed_dt,
                .cells = p.cells,
                .max_steps = p.max_steps,
                .ramp_steps = p.ramp_steps,
                .positivity = static_cast<int>(p.positivity)};
  const auto n = static_cast<std::size_t>(p.cells);
  const ExecutionSpace& space = _instance.space();
  const auto uninitialised = [&](const std::string& label) {
    return Kokkos::view_alloc(space, Kokkos::WithoutInitializing, label);
  };
  for (int k = 0; k < 3; ++k) _setup.buffer[k] = Fields(uninitialised("drogue::gas::fields"), n);
  _setup.control = decltype(_setup.control)("drogue::gas::control");
  if (p.positivity != Positivity::off)
    _setup.limited_cells = decltype(_setup.limited_cells)("drogue::gas::limited_cells", n);
  _setup.boundaries = {p.cells, p.left, p.right};
  const int team = device_team(p.block, p.cells);
  _setup.team_size = on_host ? 1 : team;
  const auto slots = [team](int wanted) { return fitting_slots(device_rows, wanted, team); };
  _setup.stage_shape = tile_shape<ExecutionSpace>(p.block, ghost_cells, slots(team));
  _setup.step_shape = tile_shape<ExecutionSpace>(
      p.block, ghost_cells * _setup.table.stages,
      slots(p.cells < large_mesh ? team : std::max(team, largest_tile / team * team)));
  _setup.gamma = p.gamma;
  _setup.dx = dx;
  _setup.splitting = p.splitting;
  _setup.average = p.face_average;
  _ring = decltype(_ring)("drogue::gas::history", row_capacity);
  std::int64_t values = p.cells;
  for (auto& level : _partial) {
    values = (values + sum_radix - 1) / sum_radix;
    level = Fields(uninitialised("drogue::gas::partial_sums"), static_cast<std::size_t>(values));
    if (values <= sum_radix) break;
  }
  make_persistent();
  space.fence("drogue::gas::solver: allocated");
}

/// Selects the persistent driver if the mesh fits the shared memory of all multiprocessors and alpha is
/// local.
template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::make_persistent() {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    using Grid = device::PersistentKernel<ExecutionSpace>;
    const Parameters& p = _parameters;
    if (!_launcher.may_be_persistent(p.driver) || p.splitting != Splitting::lf_stencil ||
        p.positivity == Positivity::on)
      return;
    const int teams = Grid::most_teams(_instance);
    if (teams == 0) return;
    // One tile per multiprocessor, one thread per slot up to the limit, and one warp for the step control.
    const int halo = ghost_cells * _setup.table.stages, warp = 32;
    const auto share = [&](std::int64_t parts) { return (p.cells + parts - 1) / parts; };
    const std::int64_t cells = std::max<std::int64_t>(share(teams), 2 * warp - 2 * halo);
    const std::int64_t slots = cells + 2 * halo;
    const TileShape shape = {static_cast<int>(cells), halo, static_cast<int>(slots)};
    const std::size_t scratch =
        sizeof(TeamControl) + sizeof(double) + Tile<ExecutionSpace>::scratch_bytes(shape);
    if (scratch > Grid::most_scratch_bytes(_instance)) return;
    const std::int64_t threads = p.block > 0 ? p.block : (slots + warp - 1) / warp * warp + warp;
    const int team = static_cast<int>(std::min<std::int64_t>(threads, largest_persistent_team));
    _persistent.emplace(PersistentSetup<ExecutionSpace>{
        {_instance, static_cast<int>(share(cells)), team, scratch, static_cast<std::size_t>(p.cells)},
        shape,
        _loop.status_view(),
        _constants});
    _launcher.use_persistent();
  }
}

template <class ExecutionSpace>
const char* GasSolver<ExecutionSpace>::driver() const {
  return stepping::driver_name(_launcher.driver());
}

template <class ExecutionSpace>
Tiling GasSolver<ExecutionSpace>::tiling() const {
  const TileShape& shape = !is_fused()   ? _setup.stage_shape
                           : _persistent ? _persistent->shape
                                         : _setup.step_shape;
  return {shape.cells, shape.halo, is_fused()};
}

template <class ExecutionSpace>
Control GasSolver<ExecutionSpace>::read_control() const {
  auto mirror = Kokkos::create_mirror_view(_setup.control);
  Kokkos::deep_copy(_instance.space(), mirror, _setup.control);
  _instance.space().fence("drogue::gas::solver: read control");
  return mirror();
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::write_control(const Control& control) {
  auto mirror = Kokkos::create_mirror_view(_setup.control);
  mirror() = control;
  mirror().trial.launches = _loop.launches();
  Kokkos::deep_copy(_instance.space(), _setup.control, mirror);
  _instance.space().fence("drogue::gas::solver: write control");
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::upload(std::int64_t first, const ConstConservedFields& fields) {
  const Fields& now = _setup.buffer[read_control().restart.current];
  const std::span<const double> part[3] = {fields.rho, fields.momentum, fields.energy};
  for (int k = 0; k < 3; ++k) copy_range(_instance.space(), field(now, k), first, part[k], true);
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::download(std::int64_t first, const ConservedFields& fields) {
  const Fields& now = _setup.buffer[read_control().restart.current];
  const std::span<double> part[3] = {fields.rho, fields.momentum, fields.energy};
  for (int k = 0; k < 3; ++k) copy_range(_instance.space(), field(now, k), first, part[k], false);
}

/// Reduces the maximum wave speeds of an uploaded state.
template <class ExecutionSpace>
struct InitialWaveSpeedFunctor {
  FieldsView<ExecutionSpace> fields;
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  double gamma;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    const CellState<double> s = cell_state<double>(gamma, fields(i, 0), fields(i, 1), fields(i, 2));
    const WaveSpeeds<double> speed = wave_speeds(s.u, s.c);
    const double values[3] = {speed.slow, speed.entropy, speed.fast};
    for (int k = 0; k < 3; ++k) {
      const auto bits = Kokkos::bit_cast<std::uint64_t>(values[k]);
      std::uint64_t& slot = control().restart.speed[k];
      if (bits > device::relaxed_load(&slot)) Kokkos::atomic_max(&slot, bits);
    }
  }
};

/// Initialises the control block from `c.restart`. Row numbers continue over the life of the solver.
/// `advance` reads the step number before a kernel publishes it.
template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::initialise_control(Control& c) {
  c.trial.stop = Stop::pause;
  c.reduction.first_inadmissible = no_failure;
  c.trial.outputs = _rows_read;
  write_control(c);
  _loop.status_view()().step = c.restart.step;
  _loop.status_view()().outputs = c.trial.outputs;
  _last_row.reset();
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::start() {
  Control c{};
  c.restart.current = read_control().restart.current;  // buffer that `upload` filled
  c.restart.limited = _parameters.positivity == Positivity::on;
  initialise_control(c);
  const ExecutionSpace& space = _instance.space();
  Kokkos::parallel_for("drogue::gas::initial_speed",
                       Kokkos::RangePolicy<ExecutionSpace>(space, 0, _parameters.cells),
                       InitialWaveSpeedFunctor<ExecutionSpace>{_setup.buffer[c.restart.current],
                                                               _setup.control, _parameters.gamma});
  space.fence("drogue::gas::solver: started");
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::restore(const RestartState& state) {
  Control c{};
  c.restart = state;
  c.restart.current = read_control().restart.current;  // buffer that `upload` filled
  initialise_control(c);
}

template <class ExecutionSpace>
struct CountLimitedCellsFunctor {
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> limited_cells;
  KOKKOS_FUNCTION void operator()(std::int64_t i, std::int64_t& sum) const { sum += limited_cells(i); }
};

template <class ExecutionSpace>
std::int64_t GasSolver<ExecutionSpace>::limited_cells() {
  std::int64_t sum = 0;
  Kokkos::parallel_reduce(
      "drogue::gas::count_limited_cells",
      Kokkos::RangePolicy<ExecutionSpace>(_instance.space(), 0,
                                          static_cast<std::int64_t>(_setup.limited_cells.extent(0))),
      CountLimitedCellsFunctor<ExecutionSpace>{_setup.limited_cells}, sum);
  return sum;
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::download_limited_cells(std::int64_t first, std::span<std::uint8_t> cells) {
  copy_range(_instance.space(), _setup.limited_cells, first, cells, false);
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::upload_limited_cells(std::int64_t first,
                                                     std::span<const std::uint8_t> cells) {
  copy_range(_instance.space(), _setup.limited_cells, first, cells, true);
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::begin_snapshot() {
  const ExecutionSpace& space = _instance.space();
  const int current = read_control().restart.current;
  const auto n = static_cast<std::size_t>(_parameters.cells);
  if (_host_snapshot.extent(0) != n) {
    const auto label = [](const std::string& text) {
      return Kokkos::view_alloc(Kokkos::WithoutInitializing, text);
    };
    _host_snapshot = HostFields(label("drogue::gas::snapshot_host"), n);
    if constexpr (!on_host) _snapshot = Fields(label("drogue::gas::snapshot"), n);
  }
  if constexpr (on_host) {
    device::copy(space, _host_snapshot, _setup.buffer[current]);
    space.fence("drogue::gas::snapshot");
  } else {
    device::copy(space, _snapshot, _setup.buffer[current]);
    space.fence("drogue::gas::snapshot");
    // The copy uses a separate stream, so steps overlap with it.
    device::copy(_copy_instance.space(), _host_snapshot, _snapshot);
  }
}

template <class ExecutionSpace>
ConstConservedFields GasSolver<ExecutionSpace>::finish_snapshot() {
  _copy_instance.space().fence("drogue::gas::snapshot: copied");
  const auto n = static_cast<std::size_t>(_parameters.cells);
  const double* data = _host_snapshot.data();
  return {{data, n}, {data + n, n}, {data + 2 * n, n}};
}

/// Calls `launch` with the reconstruction scheme as a compile-time constant. Throws as `launch` does.
template <class Launch>
void dispatch_reconstruction(const Parameters& p, const Launch& launch) {
  switch (p.weno) {
    case Weno::js:
      return launch(std::integral_constant<Reconstruction, Reconstruction::js>{});
    case Weno::m:
      return launch(std::integral_constant<Reconstruction, Reconstruction::m>{});
    case Weno::teno5:
      return launch(std::integral_constant<Reconstruction, Reconstruction::teno5>{});
    case Weno::z:
      break;
  }
  if (p.weno_power == 1) return launch(std::integral_constant<Reconstruction, Reconstruction::z1>{});
  return launch(std::integral_constant<Reconstruction, Reconstruction::z2>{});
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::enqueue_step(const ExecutionSpace& space, bool limited) const {
  dispatch_reconstruction(_parameters, [&](auto scheme) {
    if (is_fused()) return launch_step<scheme.value>(space, _setup, _parameters.precision, limited);
    for (int stage = 0; stage < _setup.table.stages; ++stage)
      launch_stage<scheme.value>(space, _setup, _parameters.precision, limited, stage);
  });
  device::launch_teams("drogue::gas::finish_step",
                       Kokkos::TeamPolicy<ExecutionSpace>(space, 1, on_host ? 1 : finish_team),
                       FinishFunctor<ExecutionSpace>{.control = _setup.control,
                                                     .status = _loop.status_view(),
                                                     .constants = _constants,
                                                     .table = _setup.table,
                                                     .limited = limited});
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::enqueue_sums(const ExecutionSpace& space, int row_every, bool always) const {
  std::int64_t n = _parameters.cells;
  int level = 0;
  for (; level == 0 || n > sum_radix; ++level) {
    const auto out = static_cast<std::int64_t>(_partial[level].extent(0));
    Kokkos::parallel_for(
        "drogue::gas::sum_level", Kokkos::RangePolicy<ExecutionSpace>(space, 0, out),
        SumLevelFunctor<ExecutionSpace>{.buffer = {_setup.buffer[0], _setup.buffer[1], _setup.buffer[2]},
                                        .control = _setup.control,
                                        .in = _partial[level == 0 ? 0 : level - 1],
                                        .out = _partial[level],
                                        .n_in = n,
                                        .n_out = out,
                                        .first = level == 0,
                                        .always = always});
    n = out;
  }
  Kokkos::parallel_for("drogue::gas::history_row", Kokkos::RangePolicy<ExecutionSpace>(space, 0, 1),
                       RowFunctor<ExecutionSpace>{.control = _setup.control,
                                                  .status = _loop.status_view(),
                                                  .ring = _ring,
                                                  .partial = _partial[level - 1],
                                                  .n = n,
                                                  .constants = _constants,
                                                  .every = row_every,
                                                  .always = always});
}

template <class ExecutionSpace>
void GasSolver<ExecutionSpace>::read_rows(const RowSink& rows) {
  for (const std::int64_t written = _loop.status().outputs; _rows_read < written; ++_rows_read) {
    _last_row = _ring(static_cast<std::size_t>(_rows_read % row_capacity));
    if (rows) rows(*_last_row);
  }
}

template <class ExecutionSpace>
HistoryRow GasSolver<ExecutionSpace>::totals() {
  enqueue_sums(_instance.space(), 0, true);
  _loop.count_launch();
  _instance.space().fence("drogue::gas::totals");
  read_rows({});
  return *_last_row;
}

/// Steps and history rows of the solver, as `StepLoop` enqueues them.
template <class ExecutionSpace>
struct GasSolver<ExecutionSpace>::DeviceSteps {
  GasSolver& solver;
  const RowSink& rows;

  void begin(const stepping::AdvanceRequest& request, std::int64_t row_step) {
    GasSolver& s = solver;
    if (const int every = request.output_every; every > 0 && every != s._row_every) {
      s._row = std::make_unique<device::CapturedGraph<ExecutionSpace>>(
          s._instance, [&s, every](const ExecutionSpace& on) { s.enqueue_sums(on, every, false); });
      s._row_every = every;
    }
    Kokkos::parallel_for("drogue::gas::begin_advance",
                         Kokkos::RangePolicy<ExecutionSpace>(s._instance.space(), 0, 1),
                         BeginAdvanceFunctor<ExecutionSpace>{.control = s._setup.control,
                                                             .status = s._loop.status_view(),
                                                             .constants = s._constants,
                                                             .request = request,
                                                             .row_step = row_step});
  }
  bool holds_many_steps(int limited) const { return solver._persistent && limited == 0; }
  void enqueue(int limited, std::int64_t max_steps) {
    GasSolver& s = solver;
    if (holds_many_steps(limited))
      return dispatch_reconstruction(s._parameters, [&](auto scheme) {
        launch_persistent_steps<scheme.value>(s._setup, *s._persistent, s._parameters.precision, max_steps);
      });
    s._launcher.launch(limited,
                       [&s, limited](const ExecutionSpace& space) { s.enqueue_step(space, limited != 0); });
  }
  void enqueue_output() { solver._row->launch(); }
  void read_outputs() { solver.read_rows(rows); }
  std::int64_t last_output() const { return solver._last_row ? solver._last_row->step : -1; }
  void write_output() {
    const HistoryRow row = solver.totals();
    if (rows) rows(row);
  }
};

template <class ExecutionSpace>
Stop GasSolver<ExecutionSpace>::advance(double target, std::int64_t pause_step, int row_every,
                                        const RowSink& rows, const Poll& poll) {
  return _loop.advance({target, pause_step, row_every}, DeviceSteps{*this, rows}, poll);
}

DROGUE_EXTERN_INSTANCES(class GasSolver)

}  // namespace drogue::gas
