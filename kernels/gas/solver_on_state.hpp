#pragma once

// Definitions of SolverOn: construction and everything that moves state.

#include <algorithm>

#include "kernels/gas/solver_on.hpp"

namespace drogue::gas {

/// On a device the slots of a tile, halo included, are its threads, a multiple, or as many as fit; on the
/// host a tile's scratch stays in the L1 cache.
template <class ExecutionSpace>
TileShape tile_shape(int block, int halo, int slots) {
  if constexpr (device::is_host<ExecutionSpace>) {
    const int cells = block > 0 ? block : 256;
    return {cells, halo, (cells + 2 * halo + 2 * device::host_lanes + 7) / 8 * 8};
  } else {
    return {slots - 2 * halo, halo, slots};
  }
}

/// Host threads that a mesh keeps busy: fewer than four tiles each are not worth a thread.
inline int useful_threads(std::int64_t cells) {
  return static_cast<int>(1 + std::min<std::int64_t>(cells / 1024, 4096));
}

template <class ExecutionSpace>
SolverOn<ExecutionSpace>::SolverOn(const Parameters& p)
    : _instance(useful_threads(p.cells)), _copy_instance(1), _parameters(p) {
  const double dx = (p.x_max - p.x_min) / static_cast<double>(p.cells);
  _setup.table = stage_table(p.time_scheme);
  const double limited_cap = p.time_scheme == TimeScheme::ssprk3 ? 0.4 : 0.8;
  _constants = {p.gamma,
                dx,
                p.cfl,
                p.cfl < limited_cap ? p.cfl : limited_cap,
                p.fixed_dt,
                p.cells,
                p.max_steps,
                p.ramp_steps,
                static_cast<int>(p.positivity)};
  const auto n = static_cast<std::size_t>(p.cells);
  const ExecutionSpace& space = _instance.space();
  const auto uninitialised = [&](const std::string& label) {
    return Kokkos::view_alloc(space, Kokkos::WithoutInitializing, label);
  };
  for (int k = 0; k < 3; ++k) _setup.buffer[k] = Fields(uninitialised("drogue::gas::fields"), n);
  _setup.control = decltype(_setup.control)("drogue::gas::control");
  if (p.positivity != Positivity::off) _setup.touched = decltype(_setup.touched)("drogue::gas::touched", n);
  _setup.ends = {p.cells, p.left, p.right};
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
  _setup.mean = p.mean;
  _status = decltype(_status)("drogue::gas::status");
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

/// Steps of a mesh that fits the multiprocessors' scratch memory share a launch, if their alpha is local.
template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::make_persistent() {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    using Grid = device::PersistentKernel<ExecutionSpace>;
    const Parameters& p = _parameters;
    const bool wanted = p.driver == Driver::persistent || p.driver == Driver::automatic;
    if (!wanted || p.splitting != Splitting::lf_stencil || p.positivity == Positivity::on) return;
    const int teams = Grid::most_teams(_instance);
    if (teams == 0) return;
    // A tile a multiprocessor, as many threads as slots while there are so many, and a warp that decides.
    const int halo = ghost_cells * _setup.table.stages, warp = 32;
    const auto share = [&](std::int64_t parts) { return (p.cells + parts - 1) / parts; };
    const std::int64_t cells = std::max<std::int64_t>(share(teams), 2 * warp - 2 * halo);
    const std::int64_t slots = cells + 2 * halo;
    const TileShape shape = {static_cast<int>(cells), halo, static_cast<int>(slots)};
    const std::size_t scratch =
        sizeof(Judgement) + sizeof(double) + Tile<ExecutionSpace>::scratch_bytes(shape);
    if (scratch > Grid::most_scratch_bytes(_instance)) return;
    const std::int64_t threads = p.block > 0 ? p.block : (slots + warp - 1) / warp * warp + warp;
    const int team = static_cast<int>(std::min<std::int64_t>(threads, largest_persistent_team));
    _persistent.emplace(PersistentSetup<ExecutionSpace>{
        {_instance, static_cast<int>(share(cells)), team, scratch, static_cast<std::size_t>(p.cells)},
        shape,
        _status,
        _constants});
  }
}

template <class ExecutionSpace>
const char* SolverOn<ExecutionSpace>::driver() const {
  if (_persistent) return "persistent";
  if (_parameters.driver == Driver::stages) return "stages";
  return _parameters.driver == Driver::plain ? "plain" : device::CapturedGraph<ExecutionSpace>::driver;
}

template <class ExecutionSpace>
Tiling SolverOn<ExecutionSpace>::tiling() const {
  const TileShape& shape = !is_fused()   ? _setup.stage_shape
                           : _persistent ? _persistent->shape
                                         : _setup.step_shape;
  return {shape.cells, shape.halo, is_fused()};
}

template <class ExecutionSpace>
Control SolverOn<ExecutionSpace>::read_control() const {
  auto mirror = Kokkos::create_mirror_view(_setup.control);
  Kokkos::deep_copy(_instance.space(), mirror, _setup.control);
  _instance.space().fence("drogue::gas::solver: read control");
  return mirror();
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::write_control(const Control& control) {
  auto mirror = Kokkos::create_mirror_view(_setup.control);
  mirror() = control;
  mirror().attempt.launches = _launched;
  Kokkos::deep_copy(_instance.space(), _setup.control, mirror);
  _instance.space().fence("drogue::gas::solver: write control");
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::upload(std::int64_t first, const ConstConserved& fields) {
  const Fields& now = _setup.buffer[read_control().resume.current];
  const std::span<const double> part[3] = {fields.rho, fields.momentum, fields.energy};
  for (int k = 0; k < 3; ++k) copy_range(_instance.space(), field(now, k), first, part[k], true);
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::download(std::int64_t first, const Conserved& fields) {
  const Fields& now = _setup.buffer[read_control().resume.current];
  const std::span<double> part[3] = {fields.rho, fields.momentum, fields.energy};
  for (int k = 0; k < 3; ++k) copy_range(_instance.space(), field(now, k), first, part[k], false);
}

/// Fastest signals of an uploaded state.
template <class ExecutionSpace>
struct InitialSpeedFunctor {
  FieldsView<ExecutionSpace> fields;
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  double gamma;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    const CellState<double> s = cell_state<double>(gamma, fields(i, 0), fields(i, 1), fields(i, 2));
    const Speeds<double> speed = signal_speeds(s.u, s.c);
    const double values[3] = {speed.slow, speed.entropy, speed.fast};
    for (int k = 0; k < 3; ++k) {
      const auto bits = Kokkos::bit_cast<std::uint64_t>(values[k]);
      std::uint64_t& slot = control().resume.speed[k];
      if (bits > Kokkos::atomic_load(&slot)) Kokkos::atomic_max(&slot, bits);
    }
  }
};

/// Makes `c`, of which `resume` is set, the state to step from. Rows are numbered over the life of the
/// solver, and `advance` must know the step before a kernel has told it.
template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::begin_at(Control& c) {
  c.attempt.stop = Stop::pause;
  c.outcome.bad = no_cell;
  c.attempt.rows = _rows_read;
  write_control(c);
  _status().step = c.resume.step;
  _status().rows = c.attempt.rows;
  _last_row.reset();
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::start() {
  Control c{};
  c.resume.current = read_control().resume.current;  // where `upload` has written
  c.resume.limited = _parameters.positivity == Positivity::on;
  begin_at(c);
  const ExecutionSpace& space = _instance.space();
  Kokkos::parallel_for("drogue::gas::initial_speed",
                       Kokkos::RangePolicy<ExecutionSpace>(space, 0, _parameters.cells),
                       InitialSpeedFunctor<ExecutionSpace>{_setup.buffer[c.resume.current], _setup.control,
                                                           _parameters.gamma});
  space.fence("drogue::gas::solver: started");
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::restore(const Resume& state) {
  Control c{};
  c.resume = state;
  c.resume.current = read_control().resume.current;  // where `upload` has written
  begin_at(c);
}

template <class ExecutionSpace>
struct CountTouchedFunctor {
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> touched;
  KOKKOS_FUNCTION void operator()(std::int64_t i, std::int64_t& sum) const { sum += touched(i); }
};

template <class ExecutionSpace>
std::int64_t SolverOn<ExecutionSpace>::touched_cells() {
  std::int64_t sum = 0;
  Kokkos::parallel_reduce("drogue::gas::count_touched",
                          Kokkos::RangePolicy<ExecutionSpace>(
                              _instance.space(), 0, static_cast<std::int64_t>(_setup.touched.extent(0))),
                          CountTouchedFunctor<ExecutionSpace>{_setup.touched}, sum);
  return sum;
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::download_touched(std::int64_t first, std::span<std::uint8_t> cells) {
  copy_range(_instance.space(), _setup.touched, first, cells, false);
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::upload_touched(std::int64_t first, std::span<const std::uint8_t> cells) {
  copy_range(_instance.space(), _setup.touched, first, cells, true);
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::begin_snapshot() {
  const ExecutionSpace& space = _instance.space();
  const int current = read_control().resume.current;
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
    // From here the copy has a stream of its own and the steps go on.
    device::copy(_copy_instance.space(), _host_snapshot, _snapshot);
  }
}

template <class ExecutionSpace>
ConstConserved SolverOn<ExecutionSpace>::finish_snapshot() {
  _copy_instance.space().fence("drogue::gas::snapshot: copied");
  const auto n = static_cast<std::size_t>(_parameters.cells);
  const double* data = _host_snapshot.data();
  return {{data, n}, {data + n, n}, {data + 2 * n, n}};
}

}  // namespace drogue::gas
