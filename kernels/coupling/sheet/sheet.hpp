#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/rank_sum.hpp"
#include "kernels/coupling/sheet/closing_sheets.hpp"
#include "kernels/coupling/sheet/local_air.hpp"
#include "kernels/coupling/sheet/sheet_parameters.hpp"
#include "kernels/coupling/spread.hpp"
#include "kernels/device/backend_list.hpp"
#include "kernels/fabric/material.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/surface/surface.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/stepping/state_list.hpp"

namespace drogue::coupling {

/// Weight of the present step in a running mean, which begins with the first step. Does not throw.
KOKKOS_INLINE_FUNCTION double weight_of(double filter, bool is_first) {
  return is_first && filter > 0.0 ? 1.0 : filter;
}

/// True if the running means of vertices have a trend. Does not throw.
inline bool has_trend(const SheetParameters& p) {
  return std::ranges::any_of(p.filter_of_vertex, [](const AirFilter& filter) { return filter.by_law; });
}

/// Sheet that exchanges forces with the air once per step of the flow: `ImmersedSheet` by delta functions,
/// `SharpSheet` by pressure jumps (`make_sheet`).
///
/// A step of the flow is `freeze`, `interpolate_air`, steps of the cloth with `relaxation`, `spread_forces`,
/// a step of the flow with these forces, `filter_acceleration`. All functions are asynchronous on the given
/// instance, allocate nothing and may be captured into a CUDA graph unless stated otherwise. They throw
/// std::invalid_argument for Views of the wrong extents.
///
/// On several ranks each has the whole cloth, and its own faces of the flow. `interpolate_air`,
/// `filter_acceleration` and `air_velocity` are then collective and block. All ranks find the same bits for
/// everything at the vertices.
template <class ExecutionSpace>
class Sheet {
 public:
  using Vectors = typename LocalAir<ExecutionSpace>::Vectors;
  using Scalars = typename LocalAir<ExecutionSpace>::Scalars;
  using Cloth = fabric::State<ExecutionSpace>;
  using Faces = FaceViews<flow::FaceView<ExecutionSpace>>;  ///< where the flow keeps them

  virtual ~Sheet() = default;
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  /// VertexForce of the fabric solver. `drag`: of lines and bodies.
  [[nodiscard]] AirRelaxation<ExecutionSpace> relaxation(
      const DragRelaxation<ExecutionSpace>& drag = {}) const {
    return {_air, drag};
  }
  /// Force of each vertex on the air in the last step of the flow, (vertices, 3), N. Does not throw.
  [[nodiscard]] const Vectors& force() const { return _force; }
  /// Weights of both directions. Does not throw.
  [[nodiscard]] const GridTransfer<ExecutionSpace>& transfer() const { return _transfer; }
  /// Arrays that continue a run with the state of cloth and flow. Does not throw.
  [[nodiscard]] const stepping::StateList<ExecutionSpace>& state() const { return _state; }

  /// Sets the force and the acceleration of the air to zero, as before the first step, but beside closing
  /// sheets to that of what drives the air. Does not throw.
  void forget_steps(const ExecutionSpace& space) const {
    _state.clear(space);
    forget_force(space);
    for (const ClosingSheet& sheet : _parameters.closing) set_driving(space, sheet);
  }

  /// Sets the force to zero unless it is a part of the state. Does not throw.
  void forget_force(const ExecutionSpace& space) const {
    if (!_air.is_explicit()) Kokkos::deep_copy(space, _force, 0.0);
  }

  /// Enqueues the geometry of the sheet, and its weights, in the middle of a step of dt, s.
  virtual void freeze(const ExecutionSpace& space, const Cloth& cloth, double dt) const = 0;

  /// Enqueues the copies of the air beside the sheet. `velocity`: of the flow, m/s.
  virtual void interpolate_air(const ExecutionSpace& space, const Faces& velocity) const = 0;

  /// Enqueues the spreading of the forces of the sheet during dt, s: adds them to `force_density`, N/m^3,
  /// which holds no others. `cloth`: after its steps.
  virtual void spread_forces(const ExecutionSpace& space, const Cloth& cloth, const Faces& force_density,
                             double dt) const = 0;

  /// Enqueues the acceleration of the air in the step of dt, s, that led to `velocity`, m/s, without that by
  /// the forces of the sheet in the step. `force_density`: of the step, N/m^3. `is_first`: no step precedes
  /// this one; `control`: of the flow.
  void filter_acceleration(const ExecutionSpace& space, const Faces& velocity, const Faces& force_density,
                           double dt, bool is_first, const flow::ControlView<ExecutionSpace>& control) const {
    filter(space, velocity, force_density, dt, is_first, control);
  }

  /// Enqueues zeros in `force_density` where the last forces were spread.
  void clear_forces(const ExecutionSpace& space, const Faces& force_density) const;

  /// Enqueues the spreading of the present forces by delta functions at the present places, as a roll-back
  /// needs it.
  void spread_again(const ExecutionSpace& space, const Faces& force_density) const;

  /// Enqueues the velocity of the flow, m/s, interpolated to where the vertices at their present positions
  /// exchange forces with it, and returns it, (vertices, 3), valid until the next step. The frozen positions
  /// stay.
  [[nodiscard]] const Vectors& air_velocity(const ExecutionSpace& space, const Cloth& cloth,
                                            const Faces& velocity) const;

 protected:
  /// Sheet of the triangles of a cloth; its other vertices, such as those of suspension lines, exchange no
  /// force with the air, whose density is in kg/m^3. `inverse_mass`: of the vertices, of `inverse_masses`.
  /// `own_faces`: those of this rank of the group, by default all. `corners`: triangles as of
  /// `ClosingSheets`. Blocks. Throws std::invalid_argument for parameters out of range.
  Sheet(const ExecutionSpace& space, const StaggeredGrid& grid, const fabric::Mesh& mesh,
        std::span<const fabric::Vector> inverse_mass, const SheetParameters& parameters, double density,
        const linear::DeviceCommunicator<ExecutionSpace>& communicator,
        const std::optional<FaceWindow>& own_faces, std::span<const std::array<int, 3>> corners)
      : _parameters((check_parameters(parameters, density), parameters)),
        _density(density),
        _surface(space, mesh),
        _transfer(space, grid, parameters.delta, _surface.vertices(), own_faces),
        _rank_sum(communicator, rows(), 2),
        _air{.area = Scalars("drogue::coupling::area", rows()),
             .normal = vectors("normal"),
             .inverse_air_mass = vectors("inverse_air_mass"),
             .before = vectors("velocity_before"),
             .acceleration = vectors("acceleration"),
             .inverse_cloth_mass = cloth_masses(space, mesh, inverse_mass),
             .velocity = vectors("local_velocity"),
             .impulse = Scalars("drogue::coupling::impulse", rows()),
             .no_slip_impulse =
                 Vectors("drogue::coupling::no_slip_impulse", has_no_slip(parameters) ? rows() : 0),
             .law = laws(space),
             .last_force = Vectors()},
        _acceleration(parameters.leak_filter > 0.0 || has_trend(parameters) ? vectors("mean_acceleration")
                                                                            : _air.acceleration),
        _force(vectors("force")),
        _after(vectors("velocity_after")),
        _closing(space, parameters.closing, _air.law, corners) {
    const bool is_explicit = parameters.method == CouplingMethod::explicit_;
    if (is_explicit) _air.last_force = _force;
    _state.add("air_acceleration", "m/s^2", _acceleration, _surface.vertices());
    _state.add("sheet_force", "N", _force, _surface.vertices(), {.restarted = is_explicit});
    _state.add("sheet_place", "m", _transfer.positions, _surface.vertices(), {.restarted = false});
  }

  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(_surface.vertices()); }
  [[nodiscard]] Vectors vectors(const std::string& name) const {
    return Vectors("drogue::coupling::" + name, rows());
  }

  /// `each` on the device, or `all` for every vertex if it is empty. Throws std::invalid_argument for another
  /// number.
  template <class T>
  [[nodiscard]] Kokkos::View<T*, typename ExecutionSpace::memory_space> of_vertices(
      const ExecutionSpace& space, const std::string& name, const std::vector<T>& each, const T& all) const {
    if (!each.empty() && each.size() != rows())
      throw std::invalid_argument("sheet: there must be one " + name + " per vertex, or none");
    const Kokkos::View<T*, typename ExecutionSpace::memory_space> result("drogue::coupling::" + name, rows());
    const auto mirror = Kokkos::create_mirror_view(result);
    for (std::size_t i = 0; i < rows(); ++i) mirror(i) = each.empty() ? all : each[i];
    Kokkos::deep_copy(space, result, mirror);
    space.fence("drogue::coupling::of_vertices");
    return result;
  }

  /// Sets the acceleration of the air beside a closing sheet to that of what drives it.
  virtual void set_driving(const ExecutionSpace& space, const ClosingSheet& sheet) const {
    Kokkos::deep_copy(space,
                      Kokkos::subview(_acceleration, std::pair(sheet.begin, sheet.end),
                                      static_cast<std::size_t>(sheet.axis)),
                      sheet.driving);
  }
  /// As `filter_acceleration`.
  virtual void filter(const ExecutionSpace& space, const Faces& velocity, const Faces& force_density,
                      double dt, bool is_first, const flow::ControlView<ExecutionSpace>& control) const = 0;
  /// Enqueues the places where the vertices at their present positions exchange forces with the air, m.
  [[nodiscard]] virtual Vectors exchange_points(const ExecutionSpace&, const Cloth& cloth) const {
    return cloth.positions;
  }

  SheetParameters _parameters;
  double _density;  ///< kg/m^3
  fabric::SurfaceViews<ExecutionSpace> _surface;
  GridTransfer<ExecutionSpace> _transfer;
  RankSum<ExecutionSpace> _rank_sum;
  LocalAir<ExecutionSpace> _air;
  Vectors _acceleration;  ///< filtered, of the air at the vertices, m/s^2
  Vectors _force, _after;
  stepping::StateList<ExecutionSpace> _state;
  ClosingSheets<ExecutionSpace> _closing;

 private:
  using Laws = Kokkos::View<PorousLaw*, typename ExecutionSpace::memory_space>;

  static void check_parameters(const SheetParameters& p, double density) {
    const auto is_valid = [](double value) { return value >= 0.0 && value <= 1e100; };
    std::vector<PorousLaw> laws = p.law_of_vertex;
    laws.push_back(p.law);
    for (const PorousLaw& law : laws)
      if (!is_valid(law.alpha) || !is_valid(law.beta))
        throw std::invalid_argument("sheet: alpha and beta must be finite and not negative");
    if (!(density > 0.0) || !is_valid(density))
      throw std::invalid_argument("sheet: the density must be positive");
    if (!(p.filter >= 0.0 && p.filter <= 1.0))
      throw std::invalid_argument("sheet: the weight of the filter must be 0 to 1");
    for (const AirFilter& filter : p.filter_of_vertex)
      if (!(filter.weight >= 0.0 && filter.weight <= 1.0))
        throw std::invalid_argument("sheet: the weight of the filter of a vertex must be 0 to 1");
    if (!(p.leak_filter >= 0.0 && p.leak_filter <= 1.0))
      throw std::invalid_argument("sheet: the weight of the defect must be 0 to 1");
    if (p.leak_filter > 0.0 && p.method != CouplingMethod::spread)
      throw std::invalid_argument("sheet: the defect is filtered with CouplingMethod::spread alone");
    if (!(p.edge_inset >= 0.0 && p.edge_inset <= 1.0))
      throw std::invalid_argument("sheet: the inset of edges must be 0 to 1 cells");
    if (p.edge_inset > 0.0 && p.method == CouplingMethod::sharp)
      throw std::invalid_argument("sheet: a sharp sheet has no inset of edges");
  }

  static bool has_no_slip(const SheetParameters& p) {
    const auto holds = [](const PorousLaw& law) { return law.no_slip; };
    return p.law_of_vertex.empty() ? p.law.no_slip : std::ranges::any_of(p.law_of_vertex, holds);
  }

  [[nodiscard]] Vectors cloth_masses(const ExecutionSpace& space, const fabric::Mesh& mesh,
                                     std::span<const fabric::Vector> inverse_mass) const {
    const Vectors result = vectors("inverse_mass");
    const auto mirror = Kokkos::create_mirror_view(result);
    for (std::size_t i = 0; i < rows(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) mirror(i, axis) = inverse_mass[i][axis];
    for (const auto& corners : mesh.triangles)
      for (const int i : corners)
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (_parameters.method == CouplingMethod::sharp && mirror(static_cast<std::size_t>(i), axis) > 0.0)
            throw std::invalid_argument("sheet: a sharp sheet needs prescribed motion");
    Kokkos::deep_copy(space, result, mirror);
    space.fence("drogue::coupling::inverse_masses");
    return result;
  }

  [[nodiscard]] Laws laws(const ExecutionSpace& space) const {
    return of_vertices(space, "porosity", _parameters.law_of_vertex, _parameters.law);
  }
};

// Outside of the class, so that only the explicit instances compile their kernels.

template <class ExecutionSpace>
void Sheet<ExecutionSpace>::clear_forces(const ExecutionSpace& space, const Faces& force_density) const {
  clear_spread(space, _transfer, force_density);
}

template <class ExecutionSpace>
void Sheet<ExecutionSpace>::spread_again(const ExecutionSpace& space, const Faces& force_density) const {
  spread(space, _transfer, _force, force_density);
}

template <class ExecutionSpace>
const typename Sheet<ExecutionSpace>::Vectors& Sheet<ExecutionSpace>::air_velocity(
    const ExecutionSpace& space, const Cloth& cloth, const Faces& velocity) const {
  GridTransfer<ExecutionSpace> present = _transfer;
  present.positions = exchange_points(space, cloth);
  interpolate(space, present, velocity, _after);
  _rank_sum(space, {_after});
  return _after;
}

DROGUE_EXTERN_INSTANCES(class Sheet)

}  // namespace drogue::coupling
