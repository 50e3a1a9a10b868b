#pragma once

#include <utility>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/flow/observables/totals.hpp"
#include "kernels/flow/state.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Takes the state after a step into account: its number, time, s, kinetic energy, J, and largest speed, m/s.
KOKKOS_INLINE_FUNCTION void add_step(Extremes& extremes, std::int64_t step, double time, double energy,
                                     double speed) {
  Extremes& e = extremes;
  if (e.step < 0) {
    e.least_energy = energy;
  } else {
    const double peak = larger_or_nan(e.peak_dissipation, (e.energy - energy) / (time - e.time));
    if (peak != e.peak_dissipation) e.peak_time = 0.5 * (e.time + time);
    e.peak_dissipation = peak;
  }
  e.largest_rise = larger_or_nan(e.largest_rise, energy - e.least_energy);
  e.least_energy = energy < e.least_energy ? energy : e.least_energy;
  e.largest_speed = larger_or_nan(e.largest_speed, speed);
  e.step = step;
  e.time = time;
  e.energy = energy;
}

/// Kinetic energy per mass, summed over cells by their volumes over that of one of widths `MacGrid::h`, and
/// the largest squared speed at their centres, m^2/s^2.
template <class ExecutionSpace>
using EnergyView = Kokkos::View<double* [2], Kokkos::LayoutRight, typename ExecutionSpace::memory_space>;

/// Sum and maximum of every eighth cell of a row along x, from each of the first eight on. On a host they are
/// the lanes of vectors, on a device threads.
template <class ExecutionSpace>
struct RowEnergyFunctor {
  static constexpr int lanes = 8, width = device::is_host<ExecutionSpace> ? lanes : 1;

  MacGrid grid;
  List<ExecutionSpace> velocity;
  EnergyView<ExecutionSpace> parts;

  KOKKOS_FUNCTION void operator()(const int index) const {
    if (grid.is_stretched())
      add_row(grid, index);
    else
      add_row(UniformWidths{grid}, index);
  }

 private:
  template <class Widths>
  KOKKOS_FUNCTION void add_row(const Widths& widths, const int index) const {
    const int part = index * width, first = part % lanes, row = part / lanes;
    const int j = row % grid.n[1], k = row / grid.n[1];
    const double* u = velocity.data() + grid.offset(0, j, k);
    const double area = widths.relative_width(1, j) * widths.relative_width(2, k);
    double sum[width] = {}, largest[width] = {};
    int i = first;
    for (; i + width <= grid.n[0]; i += lanes)
      for (int lane = 0; lane < width; ++lane)
        add(u + i + lane, area * widths.relative_width(0, i + lane), sum[lane], largest[lane]);
    for (int lane = 0; i + lane < grid.n[0] && lane < width; ++lane)
      add(u + i + lane, area * widths.relative_width(0, i + lane), sum[lane], largest[lane]);
    for (int lane = 0; lane < width; ++lane) {
      const auto at = static_cast<std::size_t>(part + lane);
      parts(at, 0) = sum[lane];
      parts(at, 1) = largest[lane];
    }
  }

  KOKKOS_FUNCTION void add(const double* u, double volume, double& sum, double& largest) const {
    double energy = 0.0, squared_speed = 0.0;
    for (int c = 0; c < 3; ++c)
      add_energy(u[c * grid.component], u[c * grid.component + edge_step(grid, c)], energy, squared_speed);
    sum += volume * energy;
    largest = larger_or_nan(largest, squared_speed);
  }
};

/// Combines entries i, i + stride, ... of `count` ones to entry i.
template <class ExecutionSpace>
struct CombineEnergiesFunctor {
  EnergyView<ExecutionSpace> from, to;
  int count, stride;

  KOKKOS_FUNCTION void operator()(const int i) const {
    double sum = 0.0, largest = 0.0;
    for (int k = i; k < count; k += stride) {
      const auto at = static_cast<std::size_t>(k);
      sum += from(at, 0);
      largest = larger_or_nan(largest, from(at, 1));
    }
    to(static_cast<std::size_t>(i), 0) = sum;
    to(static_cast<std::size_t>(i), 1) = largest;
  }
};

/// Takes a step into account once it is completed.
template <class ExecutionSpace>
struct AddStepFunctor {
  ControlView<ExecutionSpace> control;
  EnergyView<ExecutionSpace> whole;
  double cell_mass;  ///< kg
  Kokkos::View<Extremes, typename ExecutionSpace::memory_space> extremes;

  KOKKOS_FUNCTION void operator()(int) const {
    const Progress& now = control().now;
    if (now.step > extremes().step)
      add_step(extremes(), now.step, now.time, cell_mass * whole(0, 0), Kokkos::sqrt(whole(0, 1)));
  }
};

/// Extremes over all steps of a flow, on the device: without other ranks, no step visits the host. The order
/// of the sums does not depend on the backend.
template <class ExecutionSpace>
class StepExtremes {
 public:
  /// `density` in kg/m^3. Throws std::bad_alloc.
  StepExtremes(const MacGrid& grid, double density)
      : _grid(grid),
        _cell_mass(density * (grid.h[0] * grid.h[1] * grid.h[2])),
        _parts("drogue::flow::energy_parts", static_cast<std::size_t>(parts())),
        _sums("drogue::flow::energy_sums", static_cast<std::size_t>(combined(parts()))),
        _extremes("drogue::flow::extremes") {}

  /// Enqueues the comparison of the state with a velocity, m/s, with the extremes, unless its step has taken
  /// part. `ranks`: the `Halo`, which combines the energies of all ranks. Throws only after a failed launch.
  template <class Ranks>
  void enqueue(const ExecutionSpace& space, const List<ExecutionSpace>& velocity,
               const ControlView<ExecutionSpace>& control, const Ranks& ranks) const {
    using Rows = RowEnergyFunctor<ExecutionSpace>;
    device::launch_each(space, "drogue::flow::row_energies", parts() / Rows::width,
                        Rows{_grid, velocity, _parts});
    EnergyView<ExecutionSpace> from = _parts, to = _sums;
    for (int count = parts(); count > 1; std::swap(from, to)) {
      const int sums = combined(count);
      device::launch_each(space, "drogue::flow::combine_energies", sums,
                          CombineEnergiesFunctor<ExecutionSpace>{from, to, count, sums});
      count = sums;
    }
    ranks.combine(space, from);
    device::launch_each(space, "drogue::flow::extremes", 1,
                        AddStepFunctor<ExecutionSpace>{control, from, _cell_mass, _extremes});
  }

  /// Extremes so far. Blocks. Throws only after a failed kernel.
  [[nodiscard]] Extremes read(const ExecutionSpace& space) const {
    Extremes extremes;
    device::copy_out(space, &extremes, _extremes, 1);
    space.fence("drogue::flow::read_extremes");
    return extremes;
  }

  /// Replaces them. Blocks. Throws only after a failed kernel.
  void write(const ExecutionSpace& space, const Extremes& extremes) const {
    device::copy_in(space, _extremes, &extremes, 1);
    space.fence("drogue::flow::write_extremes");
  }

 private:
  /// Number of parts of rows, and of sums of `count` values.
  [[nodiscard]] int parts() const {
    return RowEnergyFunctor<ExecutionSpace>::lanes * _grid.n[1] * _grid.n[2];
  }
  [[nodiscard]] static int combined(int count) { return (count + 63) / 64; }

  MacGrid _grid;
  double _cell_mass;
  EnergyView<ExecutionSpace> _parts, _sums;
  Kokkos::View<Extremes, typename ExecutionSpace::memory_space> _extremes;
};

}  // namespace drogue::flow
