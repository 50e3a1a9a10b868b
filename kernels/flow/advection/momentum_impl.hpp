#pragma once

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/flow/advection/face_value.hpp"
#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/launch.hpp"

namespace drogue::flow {

static_assert(ghost_width == 3, "advective_flux reads three cells on each side of a face");

/// Flux of momentum component c through a face normal to axis d, per density, m^2/s^2: advection minus
/// diffusion. The face is the low face along d of the control volume of the component. `carried` points at
/// component c at the control volume, `carrier` at component d of the same cell. `skew` as
/// `AxisRow::skew`; nothing along uniform axes.
template <Advection scheme, class R, class Factor, class... Skew>
KOKKOS_INLINE_FUNCTION R momentum_flux(const double* carried, const double* carrier, std::int64_t stride_c,
                                       std::int64_t stride_d, Factor nu_over_h, R epsilon, Skew... skew) {
  R speed = 0.5 * (load_field<R>(carrier - stride_c) + load_field<R>(carrier));
  if constexpr (sizeof...(skew) > 0)
    speed = speed + (skew * ...) * (load_field<R>(carrier) - load_field<R>(carrier - stride_c));
  return advective_flux<scheme, R>(speed, carried, stride_d, epsilon) -
         nu_over_h * (load_field<R>(carried) - load_field<R>(carried - stride_d));
}

/// Widths around a cell of an axis, which a thread reads once for all components: with a load of each where
/// it is used the stage took 1.4 times as long.
struct CellWidths {
  double before, own;     ///< 1 / width of the cell before and of this one, 1/m
  double gap, gap_after;  ///< 1 / distance of the centre from those of the cells before and after, 1/m
  double skew;            ///< `AxisRow::skew`

  static KOKKOS_FUNCTION CellWidths around(const MacGrid& g, int axis, int i) {
    return {g.inverse_width(axis, i - 1), g.inverse_width(axis, i), g.inverse_gap(axis, i),
            g.inverse_gap(axis, i + 1), g.skew(axis, i)};
  }
  /// `MacGrid::inverse_extent` of a component of this axis or another one.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_extent(bool own_axis) const { return own_axis ? gap : own; }
  /// `MacGrid::inverse_step` of it, and at the next index.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_step(bool own_axis) const { return own_axis ? before : gap; }
  [[nodiscard]] KOKKOS_FUNCTION double inverse_step_after(bool own_axis) const {
    return own_axis ? own : gap_after;
  }
};

/// Momentum stage on a device; on grids with stretched axes another kernel, so that the widths cost nothing
/// on others. A thread marches along z and keeps the fluxes through the face between two planes.
template <class ExecutionSpace, Advection scheme, bool adams_bashforth, bool is_stretched>
struct MomentumFunctor {
  using Policy = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<device::largest_block, 1>>;
  using Member = typename Policy::member_type;

  MomentumSetup<ExecutionSpace> setup;
  int tiles_x, tiles_y, planes;  ///< planes that a thread treats

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const MacGrid& g = setup.grid;
    if (setup.control().trial.stop != stepping::Stop::running) return;
    const StageFactors factors = stage_factors(setup, setup.control());
    const int tile = member.league_rank();
    const int i = tile % tiles_x * tile_x + member.team_rank() % tile_x;
    const int j = tile / tiles_x % tiles_y * setup.rows + member.team_rank() / tile_x;
    const int k_begin = tile / (tiles_x * tiles_y) * planes;
    if (i >= g.n[0] || j >= g.n[1]) return;
    const int k_end = k_begin + planes < g.n[2] ? k_begin + planes : g.n[2];
    std::int64_t at = g.offset(i, j, k_begin);
    const CellWidths x = widths(0, i), y = widths(1, j);
    CellWidths z = widths(2, k_begin);
    double below[3] = {0.0, 0.0, 0.0};
    if (g.n[2] > 1)
      for (int c = 0; c < 3; ++c) below[c] = flux(c, 2, at, z.inverse_step(c == 2), skew(c, x, y, z));
    for (int k = k_begin; k < k_end; ++k, at += g.stride[2]) {
      if (is_stretched && k > k_begin) z = widths(2, k);
      double value[3], rates[3];
#if defined(__CUDA_ARCH__)
#pragma unroll 1  // code for three components would not fit the instruction cache: up to five times slower
#endif
      for (int c = 0; c < 3; ++c) {
        const std::int64_t place = c * g.component + at;
        // Loaded first, so that its latency is hidden by the fluxes.
        const double other = adams_bashforth ? factors.old_rate * setup.old_rate(place)
                                             : device::load_constant(setup.state.data() + place);
        const double skewed = skew(c, x, y, z);
        double rate = setup.acceleration[c];
        if (g.n[0] > 1)
          rate -=
              x.inverse_extent(c == 0) * (flux(c, 0, at + g.stride[0], x.inverse_step_after(c == 0), skewed) -
                                          flux(c, 0, at, x.inverse_step(c == 0), skewed));
        if (g.n[1] > 1)
          rate -=
              y.inverse_extent(c == 1) * (flux(c, 1, at + g.stride[1], y.inverse_step_after(c == 1), skewed) -
                                          flux(c, 1, at, y.inverse_step(c == 1), skewed));
        if (g.n[2] > 1) {
          const double above = flux(c, 2, at + g.stride[2], z.inverse_step_after(c == 2), skewed);
          rate -= z.inverse_extent(c == 2) * (above - below[c]);
          below[c] = above;
        }
        if (setup.eddy.data() != nullptr) rate += setup.eddy(place);
        const double stage = device::load_constant(setup.stage.data() + place);
        value[c] = stage + factors.rate * rate;
        // A store here would hold back the loads of the next component: five times slower.
        rates[c] = rate;
        value[c] += adams_bashforth ? other : factors.state * (other - stage);
      }
      for (int c = 0; c < 3; ++c) {
        const std::int64_t place = c * g.component + at;
        if (setup.force.data() != nullptr) value[c] += factors.force * setup.force(place);
        if constexpr (adams_bashforth) setup.old_rate(place) = rates[c];
        setup.out(place) = value[c];
      }
    }
  }

  KOKKOS_FUNCTION CellWidths widths(int axis, int i) const {
    if constexpr (is_stretched) return CellWidths::around(setup.grid, axis, i);
    const double inverse = setup.grid.inverse_h[axis];
    return {inverse, inverse, inverse, inverse, 0.0};
  }
  /// Skew of the velocity that carries a component across its own axis.
  static KOKKOS_FUNCTION double skew(int c, const CellWidths& x, const CellWidths& y, const CellWidths& z) {
    return c == 0 ? x.skew : c == 1 ? y.skew : z.skew;
  }
  /// Flux of component c along axis d into the control volume at the place `at`.
  KOKKOS_FUNCTION double flux(int c, int d, std::int64_t at, double inverse_step, double skewed) const {
    const MacGrid& g = setup.grid;
    const double *u = setup.stage.data(), *carried = u + c * g.component + at,
                 *carrier = u + d * g.component + at;
    const std::int64_t stride_c = g.n[c] > 1 ? g.stride[c] : 0;
    if constexpr (is_stretched)
      return momentum_flux<scheme, double>(carried, carrier, stride_c, g.stride[d], setup.nu * inverse_step,
                                           setup.epsilon, c == d ? 0.0 : skewed);
    else
      return momentum_flux<scheme, double>(carried, carrier, stride_c, g.stride[d], setup.nu * inverse_step,
                                           setup.epsilon);
  }
};

/// Momentum stage on a host: packs of cells along x, rows in turn. A row keeps the fluxes that the next row
/// and the next plane need, so that each is evaluated once.
template <class ExecutionSpace, Advection scheme, bool adams_bashforth, bool is_stretched>
struct MomentumRowsFunctor {
  using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
  using Member = typename Policy::member_type;
  using R = device::HostPack<double>;
  using Access = device::Access<R>;
  static constexpr int lanes = Access::lanes;

  MomentumSetup<ExecutionSpace> setup;
  int slabs, planes;  ///< teams, and planes of a team

  /// Numbers of a row of fluxes: one face more than cells, in whole packs.
  [[nodiscard]] static int row_length(const MacGrid& g) {
    return (g.n[0] + 1 + lanes - 1) / lanes * lanes + lanes;
  }
  [[nodiscard]] static std::size_t scratch_bytes(const MacGrid& g) {
    return static_cast<std::size_t>(3 * row_length(g)) * (static_cast<std::size_t>(g.n[1]) + 3) *
           sizeof(double);
  }

  /// For hosts alone, as the functions that it calls: a compiler of device code refuses calls of those.
  void operator()(const Member& member) const {
    const MacGrid& g = setup.grid;
    if (setup.control().trial.stop != stepping::Stop::running) return;
    const StageFactors factors = stage_factors(setup, setup.control());
    const int length = row_length(g);
    auto* below =
        static_cast<double*>(member.team_scratch(1).get_shmem(scratch_bytes(g)));  // of each row of a plane
    double* south = below + static_cast<std::int64_t>(3 * length) * g.n[1];
    double* west = south + 3 * length;
    double* next = west + 3 * length;
    const int k_begin = member.league_rank() * planes;
    const int k_end = k_begin + planes < g.n[2] ? k_begin + planes : g.n[2];
    if (g.n[2] > 1)
      for (int j = 0; j < g.n[1]; ++j)
        fluxes(2, j, k_begin, g.n[0], below + static_cast<std::int64_t>(3 * length) * j);
    for (int k = k_begin; k < k_end; ++k) {
      if (g.n[1] > 1) fluxes(1, 0, k, g.n[0], south);
      for (int j = 0; j < g.n[1]; ++j) {
        const std::int64_t at = g.offset(0, j, k);
        double* under = below + static_cast<std::int64_t>(3 * length) * j;
        for (int c = 0; c < 3; ++c)
          for (int i = 0; i < g.n[0]; i += lanes)
            Access::store(rate_row(next, c, length) + i, R(setup.acceleration[c]));
        if (g.n[0] > 1) {
          fluxes(0, j, k, g.n[0] + 1, west);
          for (int c = 0; c < 3; ++c) subtract_along_row(c, west + c * length, next + c * length);
        }
        if (g.n[1] > 1) add_difference(1, j + 1, k, length, south, west, next);
        if (g.n[2] > 1) add_difference(2, j, k + 1, length, under, west, next);
        for (int c = 0; c < 3; ++c) finish_row(c * g.component + at, next + c * length, factors);
      }
    }
  }

 private:
  static double* rate_row(double* rows, int c, int length) { return rows + c * length; }
  template <class Factor>
  static void subtract(double* place, Factor factor, R difference) {
    Access::store(place, Access::load(place) - factor * difference);
  }

  /// Subtracts the differences of fluxes along x.
  void subtract_along_row(int c, const double* west, double* rates) const {
    const MacGrid& g = setup.grid;
    const auto difference = [west](int i) { return Access::load(west + i + 1) - Access::load(west + i); };
    if (!is_stretched || !g.is_stretched(0)) {
      for (int i = 0; i < g.n[0]; i += lanes) subtract(rates + i, g.inverse_h[0], difference(i));
      return;
    }
    const double* inverse_extent = g.row(0, c == 0 ? AxisRow::inverse_gap : AxisRow::inverse_width);
    for (int i = 0; i < g.n[0]; i += lanes)
      subtract(rates + i, Access::load(inverse_extent + i), difference(i));
  }

  /// Fluxes of all components through the low faces along d of `count` control volumes of a row.
  void fluxes(int d, int j, int k, int count, double* rows) const {
    const MacGrid& g = setup.grid;
    const double* u = setup.stage.data();
    const std::int64_t at = g.offset(0, j, k);
    const int length = row_length(g);
    for (int c = 0; c < 3; ++c) {
      const double *carried = u + c * g.component + at, *carrier = u + d * g.component + at;
      const std::int64_t stride_c = g.n[c] > 1 ? g.stride[c] : 0;
      if constexpr (is_stretched) {
        stretched_fluxes(c, d, {0, j, k}, count, carried, carrier, rows + c * length);
        continue;
      }
      for (int i = 0; i < count; i += lanes)
        Access::store(rows + c * length + i,
                      momentum_flux<scheme, R>(carried + i, carrier + i, stride_c, g.stride[d],
                                               setup.nu * g.inverse_h[d], R(setup.epsilon)));
    }
  }

  /// Those of one component, of control volumes from `first` on.
  void stretched_fluxes(int c, int d, const int (&first)[3], int count, const double* carried,
                        const double* carrier, double* row) const {
    const MacGrid& g = setup.grid;
    const std::int64_t stride_c = g.n[c] > 1 ? g.stride[c] : 0;
    const bool is_skewed = c != d && g.is_stretched(c), varies_along_row = d == 0 && g.is_stretched(0);
    const R skew_of_row = is_skewed ? g.skew(c, first[c]) : 0.0,
            step_of_row = setup.nu * g.inverse_step(c, d, first[d]);
    const double* inverse_step = !varies_along_row ? nullptr
                                 : c == 0          ? g.row(0, AxisRow::inverse_width) - 1
                                                   : g.row(0, AxisRow::inverse_gap);
    const double* skew = is_skewed && c == 0 ? g.row(0, AxisRow::skew) : nullptr;
    for (int i = 0; i < count; i += lanes)
      Access::store(row + i,
                    momentum_flux<scheme, R>(
                        carried + i, carrier + i, stride_c, g.stride[d],
                        inverse_step != nullptr ? setup.nu * Access::load(inverse_step + i) : step_of_row,
                        R(setup.epsilon), skew != nullptr ? Access::load(skew + i) : skew_of_row));
  }

  /// Subtracts the difference of the fluxes at the row (j, k) and those kept in `kept`, and keeps the new
  /// ones.
  void add_difference(int d, int j, int k, int length, double* kept, double* work, double* rates) const {
    const MacGrid& g = setup.grid;
    fluxes(d, j, k, g.n[0], work);
    for (int c = 0; c < 3; ++c) {
      const double inverse_extent =
          is_stretched ? g.inverse_extent(c, d, (d == 1 ? j : k) - 1) : g.inverse_h[d];
      for (int i = 0; i < g.n[0]; i += lanes) {
        const R high = Access::load(work + c * length + i);
        subtract(rates + c * length + i, inverse_extent, high - Access::load(kept + c * length + i));
        Access::store(kept + c * length + i, high);
      }
    }
  }

  void finish_row(std::int64_t place, double* rates, const StageFactors& factors) const {
    const int n = setup.grid.n[0];
    const double *state = setup.state.data() + place, *stage = setup.stage.data() + place;
    const double* eddy = setup.eddy.data() != nullptr ? setup.eddy.data() + place : nullptr;
    double *out = setup.out.data() + place, *old = adams_bashforth ? setup.old_rate.data() + place : nullptr;
    const double* force = setup.force.data() != nullptr ? setup.force.data() + place : nullptr;
    if (eddy != nullptr)
      for (int i = 0; i < n; ++i) rates[i] += eddy[i];
    for (int i = 0; i < n; ++i) {
      double value = stage[i] + factors.rate * rates[i];
      if constexpr (adams_bashforth) {
        value += factors.old_rate * old[i];
        old[i] = rates[i];
      } else {
        value += factors.state * (state[i] - stage[i]);
      }
      out[i] = value;
    }
    if (force == nullptr) return;
    for (int i = 0; i < n; ++i) out[i] += factors.force * force[i];
  }
};

/// Enqueues a momentum stage. Asynchronous.
template <Advection scheme, bool adams_bashforth, bool is_stretched, class ExecutionSpace>
void launch_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup) {
  const MacGrid& g = setup.grid;
  const auto parts = [](int n, int size) { return (n + size - 1) / size; };
  if constexpr (device::is_host<ExecutionSpace>) {
    using Functor = MomentumRowsFunctor<ExecutionSpace, scheme, adams_bashforth, is_stretched>;
    const int planes = parts(g.n[2], space.concurrency());
    const int slabs = parts(g.n[2], planes);
    auto policy = typename Functor::Policy(space, slabs, 1)
                      .set_scratch_size(1, Kokkos::PerTeam(Functor::scratch_bytes(g)));
    device::launch_teams("drogue::flow::momentum", policy, Functor{setup, slabs, planes});
  } else {
    using Functor = MomentumFunctor<ExecutionSpace, scheme, adams_bashforth, is_stretched>;
    const int tiles_x = parts(g.n[0], tile_x), tiles_y = parts(g.n[1], setup.rows);
    const int planes = momentum_planes(scheme, tiles_x * tiles_y, g.n[2]);
    const typename Functor::Policy policy(space, tiles_x * tiles_y * parts(g.n[2], planes),
                                          tile_x * setup.rows);
    device::launch_teams("drogue::flow::momentum", policy, Functor{setup, tiles_x, tiles_y, planes});
  }
}

/// Enqueues a momentum stage on a grid with stretched axes, or without.
template <bool is_stretched, class ExecutionSpace>
void choose_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                     Advection advection) {
  const auto launch = [&]<bool adams_bashforth>() {
    switch (advection) {
      case Advection::central:
        return launch_momentum<Advection::central, adams_bashforth, is_stretched>(space, setup);
      case Advection::weno_js:
        return launch_momentum<Advection::weno_js, adams_bashforth, is_stretched>(space, setup);
      case Advection::weno_z:
        return launch_momentum<Advection::weno_z, adams_bashforth, is_stretched>(space, setup);
    }
  };
  setup.weights.adams_bashforth ? launch.template operator()<true>() : launch.template operator()<false>();
}

template <class ExecutionSpace>
void dispatch_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                       Advection advection) {
  choose_momentum<false>(space, setup, advection);
}

template <class ExecutionSpace>
void dispatch_stretched_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                                 Advection advection) {
  choose_momentum<true>(space, setup, advection);
}

}  // namespace drogue::flow
