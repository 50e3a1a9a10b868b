#pragma once

#include <optional>
#include <span>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/sheet/edge_inset.hpp"
#include "kernels/coupling/sheet/explicit_exchange.hpp"
#include "kernels/coupling/sheet/filter_weights.hpp"
#include "kernels/coupling/sheet/sheet.hpp"
#include "kernels/coupling/sheet/surface_mean.hpp"
#include "kernels/coupling/spread.hpp"

namespace drogue::coupling {

/// Change of the velocity beside vertex i that the foretold impulses of closing sheets make in the whole
/// channel, less the part that the copy of the air, of inverse masses `inverse_air`, takes by itself, m/s.
template <class ExecutionSpace>
KOKKOS_FUNCTION spatial::Point closing_change(const ClosingSheetViews<ExecutionSpace>& closing,
                                              const spatial::Point& inverse_air, int i) {
  const int k = closing(i);
  if (k < 0) return {0.0, 0.0, 0.0};
  const int axis = closing.sheets(k).axis;
  const double of_copy = dot(inverse_air, along_axis(axis, closing.impulse(k)));
  return along_axis(axis, closing.column(axis) - of_copy);
}

/// Filtered accelerations at the vertices, (vertices, 3), m/s^2.
template <class ExecutionSpace>
struct FilteredAcceleration {
  using Vectors = typename LocalAir<ExecutionSpace>::Vectors;

  fabric::ListView<ExecutionSpace, AirFilter> filter;  ///< of each vertex
  Vectors mean;                                        ///< of the air without the force of the sheet
  Vectors trend;                                       ///< of the mean, per step; empty if no vertex has one
  VertexValues<ExecutionSpace>
      defect;   ///< along the normal; `SheetParameters::leak_filter`, empty without it
  Vectors sum;  ///< of all: `LocalAir::acceleration`; `mean` without the others

  /// Takes the acceleration of a step into the mean and the trend of vertex i. `by_law`: weights of its law.
  KOKKOS_FUNCTION void take(int i, const spatial::Point& present, const FilterWeights& by_law,
                            bool is_first) const {
    using spatial::load_vector;
    const FilterWeights weights = filter(i).by_law ? by_law : FilterWeights{filter(i).weight, 0.0};
    spatial::Point before = load_vector(mean, i);
    if (trend.extent(0) > 0) {
      const spatial::Point change = load_vector(trend, i);
      before = before + change;
      const double kept = is_first ? 0.0 : 0.5, added = is_first ? 0.0 : weights.trend;
      spatial::store_vector(trend, i, kept * change + added * (present - before));
    }
    spatial::store_vector(mean, i, before + weight_of(weights.mean, is_first) * (present - before));
  }
  /// Adds the parts at vertex i of the sheet as it lies in this step.
  KOKKOS_FUNCTION void add(const LocalAir<ExecutionSpace>& air, int i) const {
    using spatial::load_vector;
    if (sum.data() == mean.data()) return;
    spatial::Point total = load_vector(mean, i);
    if (trend.extent(0) > 0) total = total + load_vector(trend, i);
    if (defect.extent(0) > 0) total = total + defect(i, 0) * load_vector(air.normal, i);
    spatial::store_vector(sum, i, total);
  }
};

template <class ExecutionSpace>
struct BeginSheetStepFunctor {
  LocalAir<ExecutionSpace> air;
  FilteredAcceleration<ExecutionSpace> filtered;

  KOKKOS_FUNCTION void operator()(const int i) const {
    filtered.add(air, i);
    spatial::store_vector(air.velocity, i, spatial::load_vector(air.before, i));
    air.impulse(i) = 0.0;
    if (air.is_no_slip(i)) spatial::store_vector(air.no_slip_impulse, i, spatial::Point{0.0, 0.0, 0.0});
  }
};

/// Copies the position of vertex i.
template <class ExecutionSpace>
struct CopyPositionFunctor {
  fabric::PointsView<ExecutionSpace> from;
  typename LocalAir<ExecutionSpace>::Vectors to;

  KOKKOS_FUNCTION void operator()(const int i) const {
    spatial::store_vector(to, i, spatial::load_vector(from, i));
  }
};

/// Velocity along its axis of a closing sheet relative to the copies of the air, m/s, weighted by area.
template <class ExecutionSpace>
struct ClosingVelocity {
  LocalAir<ExecutionSpace> air;
  fabric::PointsView<ExecutionSpace> velocities;  ///< of the vertices at the end of the step, m/s
  double dt;

  /// At vertex i, m/s.
  KOKKOS_FUNCTION spatial::Point at(int i) const {
    using spatial::load_vector;
    return load_vector(velocities, i) - load_vector(air.before, i) - dt * load_vector(air.acceleration, i);
  }
  KOKKOS_FUNCTION void operator()(const ClosingSheet& sheet, int i, ClosingMean& mean) const {
    mean.weight += air.area(i);
    mean.sum += air.area(i) * dot(at(i), along_axis(sheet.axis, 1.0));
  }
};

/// Impulses of the vertices of closing sheets. Their copies of the air contain the change that the foretold
/// impulses make in the whole channel.
template <class ExecutionSpace>
struct ClosingImpulseFunctor {
  ClosingVelocity<ExecutionSpace> velocity;
  ClosingSheetViews<ExecutionSpace> closing;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const LocalAir<ExecutionSpace>& air = velocity.air;
    if (closing(i) < 0 || !(air.area(i) > 0.0)) return;
    const spatial::Point n = spatial::load_vector(air.normal, i),
                         inverse_air = spatial::load_vector(air.inverse_air_mass, i),
                         w = velocity.at(i) - closing_change(closing, inverse_air, i);
    if (air.is_no_slip(i))
      spatial::store_vector(air.no_slip_impulse, i,
                            no_slip_impulse(air.law(i), n, w, velocity.dt, inverse_air));
    else
      air.impulse(i) = porous_impulse(air.law(i), dot(w, n), velocity.dt, dot(n, product(inverse_air, n)));
  }
};

/// Mean force of each vertex on the air during a step of the flow.
template <class ExecutionSpace>
struct SheetForceFunctor {
  LocalAir<ExecutionSpace> air;
  typename LocalAir<ExecutionSpace>::Vectors force;  ///< N
  double inverse_dt;                                 ///< 1/s

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (air.is_no_slip(i)) {
      spatial::store_vector(force, i,
                            (inverse_dt * air.area(i)) * spatial::load_vector(air.no_slip_impulse, i));
      return;
    }
    const double magnitude = inverse_dt * air.area(i) * air.impulse(i);
    spatial::store_vector(force, i, magnitude * spatial::load_vector(air.normal, i));
  }
};

/// Updates the acceleration of the air without the force of the sheet.
template <class ExecutionSpace>
struct EndSheetStepFunctor {
  LocalAir<ExecutionSpace> air;
  FilteredAcceleration<ExecutionSpace> filtered;
  typename LocalAir<ExecutionSpace>::Vectors after;  ///< velocity at the end of the step, m/s
  typename LocalAir<ExecutionSpace>::Vectors
      interpolated_force;               ///< interpolated force of the sheet per volume, N/m^3
  VertexValues<ExecutionSpace> defect;  ///< of this step along the normal, m/s^2; empty if it is not filtered
  ClosingSheetViews<ExecutionSpace> closing;
  double inverse_dt, inverse_density;
  bool is_first;

  /// Weights of the law of vertex i at its pressure difference.
  KOKKOS_FUNCTION FilterWeights weights_of_law(int i, const spatial::Point& impulse) const {
    const spatial::Point n = spatial::load_vector(air.normal, i),
                         inverse_air = spatial::load_vector(air.inverse_air_mass, i);
    return filter_weights(air.law(i), inverse_dt * dot(impulse, n), 1.0 / inverse_dt,
                          dot(n, product(inverse_air, n)));
  }
  KOKKOS_FUNCTION void operator()(const int i) const {
    using spatial::load_vector;
    const spatial::Point by_sheet = inverse_density * load_vector(interpolated_force, i),
                         present =
                             inverse_dt * (load_vector(after, i) - load_vector(air.before, i) -
                                           closing_change(closing, load_vector(air.inverse_air_mass, i), i)) -
                             by_sheet,
                         impulse = air.is_no_slip(i) ? load_vector(air.no_slip_impulse, i)
                                                     : air.impulse(i) * load_vector(air.normal, i);
    filtered.take(i, present, weights_of_law(i, impulse), is_first);
    if (defect.extent(0) == 0) return;
    const spatial::Point of_copy = inverse_dt * product(load_vector(air.inverse_air_mass, i), impulse);
    defect(i, 0) = dot(by_sheet - of_copy, load_vector(air.normal, i));
  }
};

/// Smooths the defect of a step along the sheet once.
template <class ExecutionSpace>
struct SmoothDefectFunctor {
  fabric::SurfaceViews<ExecutionSpace> surface;
  fabric::ListView<ExecutionSpace, double> triangle_area;
  VertexValues<ExecutionSpace> from, to;

  KOKKOS_FUNCTION void operator()(const int i) const {
    to(i, 0) = surface_mean(surface, triangle_area, from, i);
  }
};

/// Takes the defect of a step, smoothed once more, into its running mean.
template <class ExecutionSpace>
struct FilterDefectFunctor {
  SmoothDefectFunctor<ExecutionSpace> smooth;  ///< to the running mean
  double weight;                               ///< of this step

  KOKKOS_FUNCTION void operator()(const int i) const {
    const double present = surface_mean(smooth.surface, smooth.triangle_area, smooth.from, i),
                 mean = smooth.to(i, 0);
    smooth.to(i, 0) = mean + weight * (present - mean);
  }
};

/// Porous sheet of cloth in air, coupled by regularised delta functions with one projection per step of the
/// flow, however light the cloth. Each vertex holds a copy of the air velocity beside it whose mass is the
/// row sum of interpolation after spreading. In the steps of the cloth, this copy and the vertex relax
/// against each other by the porous law (`AirRelaxation`); at their end, the grid receives the sum of the
/// impulses. Where `PorousLaw::no_slip` holds, impulses have all components. With explicit coupling the cloth
/// imposes its velocity on the air instead (`ImposeVelocityFunctor`).
///
/// Without the filtered acceleration the energy cannot grow: a projection reduces energy, and the row sums
/// exceed the masses that interpolation and spreading give any motion of the vertices (docs/coupling.md).
template <class ExecutionSpace>
class ImmersedSheet final : public Sheet<ExecutionSpace> {
  using Base = Sheet<ExecutionSpace>;
  using Base::_acceleration, Base::_after, Base::_air, Base::_closing, Base::_density, Base::_force,
      Base::_parameters, Base::_rank_sum, Base::_state, Base::_surface, Base::_transfer;

 public:
  using typename Base::Cloth;
  using typename Base::Faces;
  using typename Base::Vectors;

  /// As the constructor of `Sheet`.
  ImmersedSheet(const ExecutionSpace& space, const StaggeredGrid& grid, const fabric::Mesh& mesh,
                std::span<const fabric::Vector> inverse_mass, const SheetParameters& parameters,
                double density, const linear::DeviceCommunicator<ExecutionSpace>& communicator = {},
                const std::optional<FaceWindow>& own_faces = {})
      : Base(space, grid, mesh, inverse_mass, parameters, density, communicator, own_faces, {}),
        _inset(space, mesh, grid, parameters.edge_inset),
        _present("drogue::coupling::present_positions", _inset.size() > 0 ? Base::rows() : 0),
        _interpolated_force(Base::vectors("interpolated_force")),
        _filter(Base::of_vertices(space, "filter", parameters.filter_of_vertex, {parameters.filter, false})) {
    if (has_trend(parameters)) {
      _trend = Base::vectors("acceleration_trend");
      _state.add("acceleration_trend", "m/s^2", _trend, _surface.vertices());
    }
    if (!(parameters.leak_filter > 0.0)) return;
    _sweeps = smoothing_sweeps(mesh, grid);
    _triangle_area = fabric::ListView<ExecutionSpace, double>("drogue::coupling::triangle_area",
                                                              static_cast<std::size_t>(_surface.triangles()));
    for (VertexValues<ExecutionSpace>* values : {&_defect, &_present_defect, &_smoothed_defect})
      *values = VertexValues<ExecutionSpace>("drogue::coupling::defect", Base::rows(), 1);
    _state.add("defect", "m/s^2", _defect, _surface.vertices());
  }

  void freeze(const ExecutionSpace& space, const Cloth& cloth, double dt) const override {
    freeze_positions(space, _transfer, cloth.positions, cloth.velocities, 0.5 * dt);
    fabric::vertex_geometry(space, _surface, _transfer.positions, _air.area, _air.normal);
    if (_defect.extent(0) > 0)
      device::launch_each(space, "drogue::coupling::triangle_area", _surface.triangles(),
                          TriangleAreaFunctor<ExecutionSpace>{_surface, _transfer.positions, _triangle_area});
    _inset(space, cloth, 0.5 * dt, _transfer.positions);
    spread_row_sums(space, _transfer, _air.area, _density, _air.inverse_air_mass);
  }

  void interpolate_air(const ExecutionSpace& space, const Faces& velocity) const override {
    interpolate(space, _transfer, velocity, _air.before);
    _rank_sum(space, {_air.inverse_air_mass, _air.before});
    device::launch_each(space, "drogue::coupling::begin_sheet_step", _transfer.points,
                        BeginSheetStepFunctor<ExecutionSpace>{_air, filtered()});
  }

  void spread_forces(const ExecutionSpace& space, const Cloth& cloth, const Faces& force_density,
                     double dt) const override {
    if (_air.is_explicit())
      device::launch_each(space, "drogue::coupling::impose_velocity", _transfer.points,
                          ImposeVelocityFunctor<ExecutionSpace>{_air, cloth.velocities, dt});
    if (!_closing.empty()) {
      const ClosingVelocity<ExecutionSpace> velocity{_air, cloth.velocities, dt};
      _closing.foretell(space, velocity, dt);
      device::launch_each(space, "drogue::coupling::closing_impulse", _transfer.points,
                          ClosingImpulseFunctor<ExecutionSpace>{velocity, _closing.views()});
    }
    device::launch_each(space, "drogue::coupling::sheet_force", _transfer.points,
                        SheetForceFunctor<ExecutionSpace>{_air, _force, 1.0 / dt});
    spread(space, _transfer, _force, force_density);
    interpolate(space, _transfer, force_density, _interpolated_force);  // before those of lines are added
  }

 private:
  void filter(const ExecutionSpace& space, const Faces& velocity, const Faces&, double dt, bool is_first,
              const flow::ControlView<ExecutionSpace>&) const override {
    interpolate(space, _transfer, velocity, _after);
    _rank_sum(space, {_after, _interpolated_force});
    device::launch_each(space, "drogue::coupling::end_sheet_step", _transfer.points,
                        EndSheetStepFunctor<ExecutionSpace>{.air = _air,
                                                            .filtered = filtered(),
                                                            .after = _after,
                                                            .interpolated_force = _interpolated_force,
                                                            .defect = _present_defect,
                                                            .closing = _closing.views(),
                                                            .inverse_dt = 1.0 / dt,
                                                            .inverse_density = 1.0 / _density,
                                                            .is_first = is_first});
    if (_defect.extent(0) > 0) filter_defect(space);
  }

  void filter_defect(const ExecutionSpace& space) const {
    SmoothDefectFunctor<ExecutionSpace> smooth{_surface, _triangle_area, _present_defect, _smoothed_defect};
    for (int k = 1; k < _sweeps; ++k) {
      device::launch_each(space, "drogue::coupling::smooth_defect", _transfer.points, smooth);
      std::swap(smooth.from, smooth.to);
    }
    smooth.to = _defect;
    device::launch_each(space, "drogue::coupling::filter_defect", _transfer.points,
                        FilterDefectFunctor<ExecutionSpace>{smooth, _parameters.leak_filter});
  }

  [[nodiscard]] Vectors exchange_points(const ExecutionSpace& space, const Cloth& cloth) const override {
    if (_inset.size() == 0) return cloth.positions;
    device::launch_each(space, "drogue::coupling::present_positions", _transfer.points,
                        CopyPositionFunctor<ExecutionSpace>{cloth.positions, _present});
    _inset(space, cloth, 0.0, _present);
    return _present;
  }

  [[nodiscard]] FilteredAcceleration<ExecutionSpace> filtered() const {
    return {.filter = _filter,
            .mean = _acceleration,
            .trend = _trend,
            .defect = _defect,
            .sum = _air.acceleration};
  }

  EdgeInset<ExecutionSpace> _inset;
  Vectors _present;  ///< positions with the inset, m; empty without it
  Vectors _interpolated_force;
  fabric::ListView<ExecutionSpace, AirFilter> _filter;  ///< of each vertex
  Vectors _trend;                                       ///< of the acceleration; empty if no vertex has one
  /// Along the normal, m/s^2: filtered, of a step, and smoothed; empty without
  /// `SheetParameters::leak_filter`.
  VertexValues<ExecutionSpace> _defect, _present_defect, _smoothed_defect;
  fabric::ListView<ExecutionSpace, double> _triangle_area;  ///< doubled, m^2; with a defect
  int _sweeps = 0;                                          ///< that smooth the defect
};

DROGUE_EXTERN_INSTANCES(class ImmersedSheet)

}  // namespace drogue::coupling
