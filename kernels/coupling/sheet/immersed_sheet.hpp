#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/rank_sum.hpp"
#include "kernels/coupling/sharp/sharp_sheet.hpp"
#include "kernels/coupling/sheet/closing_sheets.hpp"
#include "kernels/coupling/sheet/edge_inset.hpp"
#include "kernels/coupling/sheet/explicit_exchange.hpp"
#include "kernels/coupling/sheet/local_air.hpp"
#include "kernels/coupling/sheet/parameters.hpp"
#include "kernels/coupling/sheet/state_list.hpp"
#include "kernels/coupling/spread.hpp"
#include "kernels/device/backend_list.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/surface/surface.hpp"

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

template <class ExecutionSpace>
struct BeginSheetStepFunctor {
  LocalAir<ExecutionSpace> air;

  KOKKOS_FUNCTION void operator()(const int i) const {
    spatial::store_vector(air.velocity, i, spatial::load_vector(air.before, i));
    air.impulse(i) = 0.0;
    if (air.is_no_slip(i)) spatial::store_vector(air.no_slip_impulse, i, spatial::Point{0.0, 0.0, 0.0});
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

/// Filtered accelerations at the vertices, (vertices, 3), m/s^2.
template <class ExecutionSpace>
struct FilteredAcceleration {
  using Vectors = typename LocalAir<ExecutionSpace>::Vectors;

  Vectors mean;    ///< of the air without the force of the sheet
  Vectors defect;  ///< `SheetParameters::defect_filter`; empty without it: `sum` is then `mean`
  Vectors sum;     ///< of both: `LocalAir::acceleration`

  /// Adds the parts at vertex i.
  KOKKOS_FUNCTION void operator()(const int i) const {
    spatial::store_vector(sum, i, spatial::load_vector(mean, i) + spatial::load_vector(defect, i));
  }
};

/// Updates the acceleration of the air without the force of the sheet, and the defect.
template <class ExecutionSpace>
struct EndSheetStepFunctor {
  LocalAir<ExecutionSpace> air;
  FilteredAcceleration<ExecutionSpace> filtered;
  typename LocalAir<ExecutionSpace>::Vectors after;  ///< velocity at the end of the step, m/s
  typename LocalAir<ExecutionSpace>::Vectors
      interpolated_force;  ///< interpolated force of the sheet per volume, N/m^3
  ClosingSheetViews<ExecutionSpace> closing;
  double inverse_dt, inverse_density, filter, defect_filter;

  KOKKOS_FUNCTION void operator()(const int i) const {
    using spatial::load_vector;
    const spatial::Point by_sheet = inverse_density * load_vector(interpolated_force, i),
                         present =
                             inverse_dt * (load_vector(after, i) - load_vector(air.before, i) -
                                           closing_change(closing, load_vector(air.inverse_air_mass, i), i)) -
                             by_sheet,
                         mean = load_vector(filtered.mean, i);
    spatial::store_vector(filtered.mean, i, mean + filter * (present - mean));
    if (filtered.defect.extent(0) == 0) return;
    const spatial::Point impulse = air.is_no_slip(i) ? load_vector(air.no_slip_impulse, i)
                                                     : air.impulse(i) * load_vector(air.normal, i),
                         of_copy = inverse_dt * product(load_vector(air.inverse_air_mass, i), impulse),
                         defect = load_vector(filtered.defect, i);
    spatial::store_vector(filtered.defect, i, defect + defect_filter * (by_sheet - of_copy - defect));
    filtered(i);
  }
};

/// Porous sheet of cloth in air, coupled by regularised delta functions with one projection per step of the
/// flow, however light the cloth. Each vertex holds a copy of the air velocity beside it whose mass is the
/// row sum of interpolation after spreading. In the steps of the cloth, this copy and the vertex relax
/// against each other by the porous law (`AirRelaxation`); at their end, the grid receives the sum of the
/// impulses. Where `PorousLaw::no_slip` holds, impulses have all components.
///
/// Without the filtered acceleration the energy cannot grow: a projection reduces energy, and the row sums
/// exceed the masses that interpolation and spreading give any motion of the vertices (docs/coupling.md).
///
/// A step of the flow is `begin_step`, steps of the cloth with `relaxation`, `spread_forces`, a step of the
/// flow with these forces, `end_step`. All functions are asynchronous on the given instance, allocate nothing
/// and may be captured into a CUDA graph unless stated otherwise.
///
/// On several ranks each has the whole cloth, and its own faces of the flow. `begin_step` and `end_step` are
/// then collective and block. All ranks find the same bits for everything at the vertices.
template <class ExecutionSpace>
class ImmersedSheet {
 public:
  using Vectors = typename LocalAir<ExecutionSpace>::Vectors;
  using Scalars = typename LocalAir<ExecutionSpace>::Scalars;

  /// Sheet of the triangles of `cloth`; its other vertices, such as those of suspension lines, exchange no
  /// force with the air, whose density is in kg/m^3. `own_faces`: those of this rank of the group, by default
  /// all. Blocks. Throws std::invalid_argument for parameters out of range.
  ImmersedSheet(const ExecutionSpace& space, const StaggeredGrid& grid, const fabric::Parameters& cloth,
                const SheetParameters& parameters, double density, const linear::RankGroup& group = {},
                const std::optional<FaceWindow>& own_faces = {})
      : _parameters((check_parameters(parameters, density), parameters)),
        _density(density),
        _surface(space, cloth.mesh),
        _transfer(space, grid, parameters.delta, _surface.vertices(), own_faces),
        _inset(space, cloth.mesh, grid, parameters.edge_inset),
        _rank_sum(group, rows(), 2),
        _air{.area = scalars("drogue::coupling::area"),
             .normal = vectors("drogue::coupling::normal"),
             .inverse_air_mass = vectors("drogue::coupling::inverse_air_mass"),
             .before = vectors("drogue::coupling::velocity_before"),
             .acceleration = vectors("drogue::coupling::acceleration"),
             .inverse_cloth_mass = vectors("drogue::coupling::inverse_mass"),
             .velocity = vectors("drogue::coupling::local_velocity"),
             .impulse = scalars("drogue::coupling::impulse"),
             .no_slip_impulse =
                 Vectors("drogue::coupling::no_slip_impulse", has_no_slip(parameters) ? rows() : 0),
             .law = Kokkos::View<PorousLaw*, typename ExecutionSpace::memory_space>(
                 "drogue::coupling::porosity", rows()),
             .last_force = Vectors()},
        _filtered{_air.acceleration, Vectors(), _air.acceleration},
        _force(vectors("drogue::coupling::force")),
        _after(vectors("drogue::coupling::velocity_after")),
        _present("drogue::coupling::present_positions", _inset.size() > 0 ? rows() : 0),
        _interpolated_force(vectors("drogue::coupling::interpolated_force")),
        _state(_surface.vertices()) {
    if (parameters.method == CouplingMethod::explicit_) _air.last_force = _force;
    if (parameters.defect_filter > 0.0) {
      _filtered.mean = vectors("drogue::coupling::mean_acceleration");
      _filtered.defect = vectors("drogue::coupling::defect");
    }
    copy_inverse_masses(space, cloth);
    copy_laws(space);
    const bool is_sharp = parameters.method == CouplingMethod::sharp;
    _closing.emplace(space, parameters.closing, _air.law,
                     is_sharp ? cloth.mesh.triangles : std::vector<std::array<int, 3>>());
    _state.add("air_acceleration", "m/s^2", _filtered.mean);
    if (parameters.defect_filter > 0.0) _state.add("defect", "m/s^2", _filtered.defect);
    _state.add("sheet_force", "N", _force, {.restarted = parameters.method == CouplingMethod::explicit_});
    _state.add("sheet_place", "m", _transfer.positions, {.restarted = false});
    if (!is_sharp) return;
    _transfer.has_stencils = false;
    _sharp.emplace(_transfer, _surface, _air.law, density, *_closing);
    // Not changed by failed steps.
    _state.add("face_acceleration", "m/s^2", _sharp->list(), {.saved = false});
  }

  /// VertexForce of the fabric solver.
  [[nodiscard]] AirRelaxation<ExecutionSpace> relaxation() const { return {_air}; }
  /// Force of each vertex on the air in the last step of the flow, (vertices, 3), N. Does not throw.
  [[nodiscard]] const Vectors& force() const { return _force; }
  /// Arrays that continue a run with the state of cloth and flow. Does not throw.
  [[nodiscard]] const StateList<ExecutionSpace>& state() const { return _state; }
  /// Weights of both directions. Does not throw.
  [[nodiscard]] const GridTransfer<ExecutionSpace>& transfer() const { return _transfer; }

  /// Sets the force and the acceleration of the air to zero, as before the first step, but beside closing
  /// sheets to that of what drives the air. Asynchronous. Does not throw.
  void forget_steps(const ExecutionSpace& space) const {
    _state.clear(space);
    Kokkos::deep_copy(space, _force, 0.0);
    for (const ClosingSheet& sheet : _parameters.closing) {
      const auto axis = static_cast<std::size_t>(sheet.axis);
      if (_sharp) Kokkos::deep_copy(space, _sharp->acceleration().component[axis], sheet.driving);
      const auto vertices = std::pair(sheet.begin, sheet.end);
      Kokkos::deep_copy(space, Kokkos::subview(_filtered.mean, vertices, axis), sheet.driving);
    }
    update_acceleration(space);
  }

  /// Enqueues what a change of the state makes necessary. Throws only after a failed kernel.
  void update_acceleration(const ExecutionSpace& space) const {
    if (_filtered.defect.extent(0) > 0)
      device::launch_each(space, "drogue::coupling::add_defect", _transfer.points, _filtered);
  }

  /// Enqueues the geometry of the sheet in the middle of a step of dt, s, and the air at its vertices.
  /// `velocity`: of the flow at the faces, m/s. Throws std::invalid_argument for Views of the wrong extents.
  template <class View>
  void begin_step(const ExecutionSpace& space, const fabric::State<ExecutionSpace>& cloth,
                  const FaceViews<View>& velocity, double dt) const {
    freeze_positions(space, _transfer, cloth.positions, cloth.velocities, 0.5 * dt);
    if (_sharp) return _sharp->begin_step(space, velocity);
    fabric::vertex_geometry(space, _surface, _transfer.positions, _air.area, _air.normal);
    _inset(space, cloth, 0.5 * dt, _transfer.positions);
    spread_row_sums(space, _transfer, _air.area, _density, _air.inverse_air_mass);
    interpolate(space, _transfer, velocity, _air.before);
    _rank_sum(space, {_air.inverse_air_mass, _air.before});
    device::launch_each(space, "drogue::coupling::begin_sheet_step", _transfer.points,
                        BeginSheetStepFunctor<ExecutionSpace>{_air});
  }

  /// Enqueues the spreading of the forces of the sheet during dt, s: adds them to `force_density`, N/m^3.
  /// `cloth`: after its steps. Throws as `begin_step`.
  template <class View>
  void spread_forces(const ExecutionSpace& space, const fabric::State<ExecutionSpace>& cloth,
                     const FaceViews<View>& force_density, double dt) const {
    if (_sharp) return _sharp->exchange(space, cloth.velocities, force_density, _force, dt);
    if (_air.is_explicit())
      device::launch_each(space, "drogue::coupling::impose_velocity", _transfer.points,
                          ImposeVelocityFunctor<ExecutionSpace>{_air, cloth.velocities, dt});
    if (!_closing->empty()) {
      const ClosingVelocity<ExecutionSpace> velocity{_air, cloth.velocities, dt};
      _closing->foretell(space, velocity, dt);
      device::launch_each(space, "drogue::coupling::closing_impulse", _transfer.points,
                          ClosingImpulseFunctor<ExecutionSpace>{velocity, _closing->views()});
    }
    device::launch_each(space, "drogue::coupling::sheet_force", _transfer.points,
                        SheetForceFunctor<ExecutionSpace>{_air, _force, 1.0 / dt});
    spread(space, _transfer, _force, force_density);
  }

  /// Enqueues the acceleration of the air in the step of dt, s, that led to `velocity`, m/s, under the forces
  /// of the sheet alone in `force_density`, N/m^3. `is_first`: no step precedes this one; `control`: of the
  /// flow. Throws as `begin_step`.
  template <class View, class Control>
  void end_step(const ExecutionSpace& space, const FaceViews<View>& velocity,
                const FaceViews<View>& force_density, double dt, bool is_first,
                const Control& control) const {
    const double filter = is_first && _parameters.filter > 0.0 ? 1.0 : _parameters.filter;
    if (_sharp) return _sharp->end_step(space, velocity, force_density, dt, filter, control);
    interpolate(space, _transfer, velocity, _after);
    interpolate(space, _transfer, force_density, _interpolated_force);
    _rank_sum(space, {_after, _interpolated_force});
    device::launch_each(space, "drogue::coupling::end_sheet_step", _transfer.points,
                        EndSheetStepFunctor<ExecutionSpace>{.air = _air,
                                                            .filtered = _filtered,
                                                            .after = _after,
                                                            .interpolated_force = _interpolated_force,
                                                            .closing = _closing->views(),
                                                            .inverse_dt = 1.0 / dt,
                                                            .inverse_density = 1.0 / _density,
                                                            .filter = filter,
                                                            .defect_filter = _parameters.defect_filter});
  }

  /// Enqueues the velocity of the flow, m/s, interpolated to where the vertices at their present positions
  /// exchange forces with it, and returns it, (vertices, 3), valid until the next step. `velocity`: as in
  /// `begin_step`. The frozen positions stay. On several ranks collective; blocks there. Throws as
  /// `begin_step`.
  template <class View>
  [[nodiscard]] const Vectors& air_velocity(const ExecutionSpace& space,
                                            const fabric::State<ExecutionSpace>& cloth,
                                            const FaceViews<View>& velocity) const {
    GridTransfer<ExecutionSpace> present = _transfer;
    present.positions = cloth.positions;
    if (_inset.size() > 0) {
      device::launch_each(space, "drogue::coupling::present_positions", _transfer.points,
                          CopyRowsFunctor<ExecutionSpace>{1, {cloth.positions}, {_present}});
      _inset(space, cloth, 0.0, _present);
      present.positions = _present;
    }
    interpolate(space, present, velocity, _after);
    _rank_sum(space, {_after});
    return _after;
  }

 private:
  static void check_parameters(const SheetParameters& p, double density) {
    const auto is_valid = [](double value) { return value >= 0.0 && value <= 1e100; };
    std::vector<PorousLaw> laws = p.law_of_vertex;
    laws.push_back(p.law);
    for (const PorousLaw& law : laws)
      if (!is_valid(law.alpha) || !is_valid(law.beta))
        throw std::invalid_argument("immersed sheet: alpha and beta must be finite and not negative");
    if (!(density > 0.0) || !is_valid(density))
      throw std::invalid_argument("immersed sheet: the density must be positive");
    if (!(p.filter >= 0.0 && p.filter <= 1.0))
      throw std::invalid_argument("immersed sheet: the weight of the filter must be 0 to 1");
    if (!(p.defect_filter >= 0.0 && p.defect_filter <= 0.2))
      throw std::invalid_argument("immersed sheet: the weight of the defect must be 0 to 0.2");
    if (p.defect_filter > 0.0 && p.method != CouplingMethod::spread)
      throw std::invalid_argument("immersed sheet: the defect is filtered with CouplingMethod::spread alone");
    if (!(p.edge_inset >= 0.0 && p.edge_inset <= 1.0))
      throw std::invalid_argument("immersed sheet: the inset of edges must be 0 to 1 cells");
    if (p.edge_inset > 0.0 && p.method == CouplingMethod::sharp)
      throw std::invalid_argument("immersed sheet: a sharp sheet has no inset of edges");
  }

  static bool has_no_slip(const SheetParameters& p) {
    const auto holds = [](const PorousLaw& law) { return law.no_slip; };
    return p.law_of_vertex.empty() ? p.law.no_slip : std::ranges::any_of(p.law_of_vertex, holds);
  }

  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(_surface.vertices()); }
  [[nodiscard]] Scalars scalars(const std::string& label) const { return Scalars(label, rows()); }
  [[nodiscard]] Vectors vectors(const std::string& label) const { return Vectors(label, rows()); }

  void copy_inverse_masses(const ExecutionSpace& space, const fabric::Parameters& cloth) const {
    const auto mirror = Kokkos::create_mirror_view(_air.inverse_cloth_mass);
    for (std::size_t i = 0; i < rows(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_pinned = !cloth.pinned.empty() && (cloth.pinned[i] >> axis & 1U) != 0U;
        mirror(i, axis) = is_pinned ? 0.0 : 1.0 / cloth.mass[i];
      }
    for (const fabric::Motion& motion : cloth.motions)
      for (const int i : motion.vertices) mirror(i, motion.axis) = 0.0;
    for (const auto& corners : cloth.mesh.triangles)
      for (const int i : corners)
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (_parameters.method == CouplingMethod::sharp && mirror(static_cast<std::size_t>(i), axis) > 0.0)
            throw std::invalid_argument("immersed sheet: a sharp sheet needs prescribed motion");
    Kokkos::deep_copy(space, _air.inverse_cloth_mass, mirror);
    space.fence("drogue::coupling::immersed_sheet");
  }

  void copy_laws(const ExecutionSpace& space) const {
    const std::vector<PorousLaw>& laws = _parameters.law_of_vertex;
    if (!laws.empty() && laws.size() != rows())
      throw std::invalid_argument("immersed sheet: there must be one porous law per vertex, or none");
    const auto mirror = Kokkos::create_mirror_view(_air.law);
    for (std::size_t i = 0; i < rows(); ++i) mirror(i) = laws.empty() ? _parameters.law : laws[i];
    Kokkos::deep_copy(space, _air.law, mirror);
    space.fence("drogue::coupling::immersed_sheet: porosity");
  }

  SheetParameters _parameters;
  double _density;  ///< kg/m^3
  fabric::SurfaceViews<ExecutionSpace> _surface;
  GridTransfer<ExecutionSpace> _transfer;
  EdgeInset<ExecutionSpace> _inset;
  RankSum<ExecutionSpace> _rank_sum;
  LocalAir<ExecutionSpace> _air;
  FilteredAcceleration<ExecutionSpace> _filtered;
  Vectors _force, _after;
  Vectors _present;  ///< positions with the inset, m; empty without it
  Vectors _interpolated_force;
  StateList<ExecutionSpace> _state;
  std::optional<ClosingSheets<ExecutionSpace>> _closing;  ///< never empty
  std::optional<SharpSheet<ExecutionSpace>> _sharp;
};

DROGUE_EXTERN_INSTANCES(class ImmersedSheet)

}  // namespace drogue::coupling
