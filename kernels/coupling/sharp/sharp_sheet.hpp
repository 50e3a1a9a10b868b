#pragma once

#include <optional>
#include <span>

#include "kernels/coupling/sharp/crossings.hpp"
#include "kernels/coupling/sheet/sheet.hpp"
#include "kernels/device/relaxed_access.hpp"
#include "kernels/stepping/status.hpp"

namespace drogue::coupling {

/// Data of a sharp sheet as kernels read them.
template <class ExecutionSpace>
struct SharpSheetViews {
  using Memory = typename ExecutionSpace::memory_space;
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory>;

  fabric::SurfaceViews<ExecutionSpace> surface;
  Vectors positions;                                ///< of the vertices, m
  Vectors velocities;                               ///< of the vertices, m/s
  Kokkos::View<PorousLaw*, Memory> law;             ///< of the vertices
  Kokkos::View<FixedPoint[2], Memory> largest;      ///< as of `GridTransfer`
  Kokkos::View<double* [9], Memory> corner_force;   ///< of triangles: component c of corner k at 3 k + c, N
  FaceArrays<const double> velocity, acceleration;  ///< of the air, m/s and m/s^2
  FaceArrays<int> count;                            ///< crossings at each face; zero between steps
  FaceArrays<FixedPoint> sums;                      ///< impulses per area; zero between steps
  FaceArrays<double> force_density;                 ///< force on the air, N/m^3
  ClosingSheetViews<ExecutionSpace> closing;
  FaceArrays<double> foretold;  ///< force of closing sheets on the air, N/m^3; zero between steps
  GridAxes axes;
  double dt, inverse_density;  ///< s, m^3/kg
  double summands;             ///< bound on the crossings at a face, a power of two

  /// Calls `visit(crossing, impulse)` for each crossing of triangle t: the impulse per area along the axis of
  /// the crossing on the air, Pa s. Crossings at one face share its air equally.
  template <class Visit>
  KOKKOS_FUNCTION void for_each_impulse(int t, const Visit& visit) const {
    const int vertex[3] = {surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2)};
    spatial::Point corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = spatial::load_vector(positions, vertex[k]);
    const spatial::Point area = fabric::doubled_area_vector(corner[0], corner[1], corner[2]);
    const double along[3] = {area.x, area.y, area.z};
    const double length = Kokkos::sqrt(dot(area, area));
    for_each_crossing(axes, corner, vertex, [&](const Crossing& at) {
      const int d = at.component;
      double moving = 0.0;
      for (int k = 0; k < 3; ++k) moving += at.weight[k] * velocities(vertex[k], d);
      const double air = velocity.at(d, at.face) + dt * acceleration.at(d, at.face);
      // Flow through the sheet is along its normal: its component along the axis is this part of it.
      const double part = Kokkos::fabs(along[d]) / length, sign = along[d] > 0.0 ? 1.0 : -1.0;
      const double inverse_air_mass =
          count.at(d, at.face) * inverse_density * axes.axis[d].inverse_spacing / part;
      const double relative =
          moving - air - closing_change(vertex[0], d, count.at(d, at.face), inverse_air_mass);
      visit(at, sign * porous_impulse(law(vertex[0]), sign * relative / part, dt, inverse_air_mass));
    });
  }

  /// As for the vertices of an immersed sheet, at a face with a number of crossings. Where there are several,
  /// the filtered acceleration foretells what they change beside each other.
  KOKKOS_FUNCTION double closing_change(int vertex, int d, int crossings, double inverse_air_mass) const {
    const int k = closing(vertex);
    if (k < 0 || closing.sheets(k).axis != d) return 0.0;
    return closing.column(d) - (crossings == 1 ? inverse_air_mass * closing.impulse(k) : 0.0);
  }

  /// Area of a face normal to an axis, m^2.
  KOKKOS_FUNCTION double face_area(int axis) const {
    return 1.0 / (axes.axis[cyclic_axis(axis, 1)].inverse_spacing *
                  axes.axis[cyclic_axis(axis, 2)].inverse_spacing);
  }
};

/// Counts the crossings at each face.
template <class ExecutionSpace>
struct CountCrossingsFunctor {
  SharpSheetViews<ExecutionSpace> sheet;

  KOKKOS_FUNCTION void operator()(const int t) const {
    const auto& s = sheet;
    const int vertex[3] = {s.surface.corner(t, 0), s.surface.corner(t, 1), s.surface.corner(t, 2)};
    spatial::Point corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = spatial::load_vector(s.positions, vertex[k]);
    for_each_crossing(s.axes, corner, vertex,
                      [&](const Crossing& at) { Kokkos::atomic_add(&s.count.at(at.component, at.face), 1); });
  }
};

/// Velocity along its axis of a closing sheet relative to the air, m/s: a sum over the crossings of a
/// triangle.
template <class ExecutionSpace>
struct SharpClosingVelocity {
  SharpSheetViews<ExecutionSpace> sheet;

  KOKKOS_FUNCTION void operator()(const ClosingSheet& closing, int t, ClosingMean& mean) const {
    const auto& s = sheet;
    const int vertex[3] = {s.surface.corner(t, 0), s.surface.corner(t, 1), s.surface.corner(t, 2)};
    spatial::Point corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = spatial::load_vector(s.positions, vertex[k]);
    for_each_crossing(s.axes, corner, vertex, [&](const Crossing& at) {
      const int d = at.component;
      if (d != closing.axis) return;
      mean.weight += 1.0;
      mean.sum -= s.velocity.at(d, at.face) + s.dt * s.acceleration.at(d, at.face);
      for (int k = 0; k < 3; ++k) mean.sum += at.weight[k] * s.velocities(vertex[k], d);
    });
  }
};

/// Largest magnitude of the impulses.
template <class ExecutionSpace>
struct LargestCrossingFunctor {
  SharpSheetViews<ExecutionSpace> sheet;

  KOKKOS_FUNCTION void operator()(const int t) const {
    double largest = 0.0;
    sheet.for_each_impulse(t, [&](const Crossing&, double impulse) {
      const double magnitude = Kokkos::fabs(impulse);
      if (magnitude > largest && magnitude <= 1e270) largest = magnitude;
    });
    const auto bits = Kokkos::bit_cast<FixedPoint>(largest);
    if (bits > device::relaxed_load(&sheet.largest(0))) Kokkos::atomic_max(&sheet.largest(0), bits);
  }
};

/// Adds the impulses to the sums of faces, and stores the forces of each triangle on the air at its corners.
template <class ExecutionSpace>
struct AddCrossingsFunctor {
  SharpSheetViews<ExecutionSpace> sheet;
  Kokkos::View<TransferCounts, typename ExecutionSpace::memory_space> counts;

  KOKKOS_FUNCTION void operator()(const int t) const {
    const double largest = Kokkos::bit_cast<double>(sheet.largest(0));
    if (t == 0) sheet.largest(1) = Kokkos::bit_cast<FixedPoint>(largest);
    const double factor = fixed_point_scale(largest, sheet.summands).factor;
    double force[9] = {};
    sheet.for_each_impulse(t, [&](const Crossing& at, double impulse) {
      if (!(Kokkos::fabs(impulse) <= largest)) {
        Kokkos::atomic_add(&counts().rejected_forces, 1LL);
        return;
      }
      Kokkos::atomic_add(&sheet.sums.at(at.component, at.face),
                         static_cast<FixedPoint>(to_fixed_point(impulse * factor)));
      const double whole = impulse / sheet.dt * sheet.face_area(at.component);
      for (int k = 0; k < 3; ++k) force[3 * k + at.component] += at.weight[k] * whole;
    });
    for (int k = 0; k < 9; ++k) sheet.corner_force(t, k) = force[k];
  }
};

/// Adds the sums of faces to the density of the force and resets them and the counts.
template <class ExecutionSpace>
struct FlushSumsFunctor {
  SharpSheetViews<ExecutionSpace> sheet;

  KOKKOS_FUNCTION void operator()(const int t) const {
    if (t == 0) sheet.largest(0) = 0;
    const auto& s = sheet;
    const double unit = fixed_point_scale(Kokkos::bit_cast<double>(s.largest(1)), s.summands).inverse / s.dt;
    const int vertex[3] = {s.surface.corner(t, 0), s.surface.corner(t, 1), s.surface.corner(t, 2)};
    spatial::Point corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = spatial::load_vector(s.positions, vertex[k]);
    for_each_crossing(s.axes, corner, vertex, [&](const Crossing& at) {
      const int d = at.component;
      const int k = s.closing(vertex[0]);
      if (k >= 0 && s.closing.sheets(k).axis == d && device::relaxed_load(&s.count.at(d, at.face)) == 1)
        s.foretold.at(d, at.face) = s.closing.impulse(k) * s.axes.axis[d].inverse_spacing / s.dt;
      device::relaxed_store(&s.count.at(d, at.face), 0);
      const FixedPoint taken = Kokkos::atomic_exchange(&s.sums.at(d, at.face), FixedPoint{0});
      if (taken != 0)
        s.force_density.at(d, at.face) += unit * s.axes.axis[d].inverse_spacing * from_fixed_point(taken);
    });
  }
};

/// Force of each vertex on the air, gathered in ascending order of its triangles.
template <class ExecutionSpace>
struct GatherCornersFunctor {
  SharpSheetViews<ExecutionSpace> sheet;
  typename SharpSheetViews<ExecutionSpace>::Vectors force;  ///< N

  KOKKOS_FUNCTION void operator()(const int i) const {
    spatial::Point sum{0.0, 0.0, 0.0};
    for (int k = sheet.surface.first(i); k < sheet.surface.first(i + 1); ++k) {
      const int t = sheet.surface.around(k);
      for (int c = 0; c < 3; ++c)
        if (sheet.surface.corner(t, c) == i)
          sum = sum + spatial::Point{sheet.corner_force(t, 3 * c), sheet.corner_force(t, 3 * c + 1),
                                     sheet.corner_force(t, 3 * c + 2)};
    }
    spatial::store_vector(force, i, sum);
  }
};

/// Copies the velocity at all faces.
struct SaveFacesFunctor {
  FaceArrays<const double> from;
  FaceArrays<double> to;
  int faces[3][3];  ///< of each component along each axis

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const int index[3] = {i, j, k};
    for (int d = 0; d < 3; ++d) {
      if (i >= faces[d][0] || j >= faces[d][1] || k >= faces[d][2]) continue;
      const FaceIndex face{index[d], index[cyclic_axis(d, 1)], index[cyclic_axis(d, 2)]};
      to.at(d, face) = from.at(d, face);
    }
  }
};

/// Updates the acceleration of the air at all faces without the force of the sheet, unless the flow failed.
template <class ExecutionSpace>
struct EndSharpStepFunctor {
  FaceArrays<const double> before, after, force_density;
  FaceArrays<double> acceleration;
  int faces[3][3];
  double inverse_dt, inverse_density, filter;
  flow::ControlView<ExecutionSpace> control;
  FaceArrays<double> foretold;  ///< force of closing sheets, N/m^3; reset
  ClosingSheetViews<ExecutionSpace> closing;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const bool failed = control().trial.stop == stepping::Stop::failed,
               closes = closing.sheet_of.extent(0) > 0;
    const int index[3] = {i, j, k};
    for (int d = 0; d < 3; ++d) {
      if (i >= faces[d][0] || j >= faces[d][1] || k >= faces[d][2]) continue;
      const FaceIndex face{index[d], index[cyclic_axis(d, 1)], index[cyclic_axis(d, 2)]};
      double present =
          inverse_dt * (after.at(d, face) - before.at(d, face)) - inverse_density * force_density.at(d, face);
      if (closes) {
        present += inverse_density * foretold.at(d, face) - inverse_dt * closing.column(d);
        foretold.at(d, face) = 0.0;
      }
      if (failed) continue;
      double& mean = acceleration.at(d, face);
      mean += filter * (present - mean);
    }
  }
};

/// Sheet in prescribed motion as an internal boundary: a pressure jump between neighbouring cells that it
/// separates, and no force elsewhere. In the difference of their pressures, and so on the right-hand side of
/// the pressure equation, a jump is a force per volume on the face between them, which `spread_forces` adds.
///
/// Each crossing of a line between centres and the sheet obeys the porous law by itself: the fluid passes
/// along the normal of the sheet, so that the component at the face gives the normal velocity. An impermeable
/// sheet prescribes the velocity on a closed surface of faces and has no leak. As with `ImmersedSheet`, one
/// projection per step suffices, since the filtered acceleration without the sheet foretells its change.
template <class ExecutionSpace>
class SharpSheet final : public Sheet<ExecutionSpace> {
  using Base = Sheet<ExecutionSpace>;
  using Base::_air, Base::_closing, Base::_density, Base::_force, Base::_parameters, Base::_state,
      Base::_surface, Base::_transfer;

 public:
  using typename Base::Cloth;
  using typename Base::Faces;
  using Views = SharpSheetViews<ExecutionSpace>;
  using Memory = typename ExecutionSpace::memory_space;
  template <class T>
  using OwnFaces = FaceViews<Kokkos::View<T***, Kokkos::LayoutLeft, Memory>>;

  /// As the constructor of `Sheet`, on one rank.
  SharpSheet(const ExecutionSpace& space, const StaggeredGrid& grid, const fabric::Mesh& mesh,
             std::span<const fabric::Vector> inverse_mass, const SheetParameters& parameters, double density,
             const linear::DeviceCommunicator<ExecutionSpace>& communicator = {},
             const std::optional<FaceWindow>& own_faces = {})
      : Base(space, grid, mesh, inverse_mass, parameters, density, communicator, own_faces, mesh.triangles),
        _corner_force("drogue::coupling::corner_force", static_cast<std::size_t>(_surface.triangles())),
        _count(faces_of<int>("drogue::coupling::crossings")),
        _before(faces_of<double>("drogue::coupling::velocity_before")),
        _foretold(faces_of<double>("drogue::coupling::foretold_force")) {
    _transfer.has_stencils = false;
    std::size_t faces = 0;
    for (const auto& component : _before.component) faces += component.size();
    // All components are one list.
    _face_list = Kokkos::View<double* [1], Memory>("drogue::coupling::face_acceleration", faces);
    double* first = _face_list.data();
    for (int d = 0; d < 3; ++d) {
      const auto& like = _before.component[d];
      _face_acceleration.component[d] = Kokkos::View<double***, Kokkos::LayoutLeft, Memory>(
          first, like.extent(0), like.extent(1), like.extent(2));
      first += like.size();
    }
    // Not changed by failed steps.
    _state.add("face_acceleration", "m/s^2", _face_list, static_cast<int>(faces), {.saved = false});
  }

  void freeze(const ExecutionSpace& space, const Cloth& cloth, double dt) const override {
    freeze_positions(space, _transfer, cloth.positions, cloth.velocities, 0.5 * dt);
  }

  void interpolate_air(const ExecutionSpace& space, const Faces& velocity) const override {
    SaveFacesFunctor save{constant(velocity), face_arrays(_transfer.window, _before), {}};
    launch_faces(space, "drogue::coupling::save_faces", save);
  }

  void spread_forces(const ExecutionSpace& space, const Cloth& cloth, const Faces& force_density,
                     double dt) const override {
    const StaggeredGrid& grid = _transfer.grid;
    const int triangles = _surface.triangles();
    const Views views{.surface = _surface,
                      .positions = _transfer.positions,
                      .velocities = cloth.velocities,
                      .law = _air.law,
                      .largest = _transfer.largest,
                      .corner_force = _corner_force,
                      .velocity = constant(_before),
                      .acceleration = constant(_face_acceleration),
                      .count = face_arrays(_transfer.window, _count),
                      .sums = face_arrays(_transfer.window, _transfer.sums),
                      .force_density = face_arrays(_transfer.window, force_density),
                      .closing = _closing.views(),
                      .foretold = face_arrays(_transfer.window, _foretold),
                      .axes = grid_axes(grid),
                      .dt = dt,
                      .inverse_density = 1.0 / _density,
                      .summands = summand_bound(3 * triangles)};
    const auto launch = [&](const char* label, const auto& functor) {
      device::launch_each(space, label, triangles, functor);
    };
    launch("drogue::coupling::count_crossings", CountCrossingsFunctor<ExecutionSpace>{views});
    if (!_closing.empty()) _closing.foretell(space, SharpClosingVelocity<ExecutionSpace>{views}, dt);
    launch("drogue::coupling::largest_crossing", LargestCrossingFunctor<ExecutionSpace>{views});
    launch("drogue::coupling::add_crossings", AddCrossingsFunctor<ExecutionSpace>{views, _transfer.counts});
    launch("drogue::coupling::flush_sums", FlushSumsFunctor<ExecutionSpace>{views});
    device::launch_each(space, "drogue::coupling::gather_corners", _surface.vertices(),
                        GatherCornersFunctor<ExecutionSpace>{views, _force});
  }

 private:
  void filter(const ExecutionSpace& space, const Faces& velocity, const Faces& force_density, double dt,
              bool is_first, const flow::ControlView<ExecutionSpace>& control) const override {
    EndSharpStepFunctor<ExecutionSpace> end{.before = constant(_before),
                                            .after = constant(velocity),
                                            .force_density = constant(force_density),
                                            .acceleration = face_arrays(_transfer.window, _face_acceleration),
                                            .faces = {},
                                            .inverse_dt = 1.0 / dt,
                                            .inverse_density = 1.0 / _density,
                                            .filter = weight_of(_parameters.filter, is_first),
                                            .control = control,
                                            .foretold = face_arrays(_transfer.window, _foretold),
                                            .closing = _closing.views()};
    launch_faces(space, "drogue::coupling::end_sharp_step", end);
  }

  void set_driving(const ExecutionSpace& space, const ClosingSheet& sheet) const override {
    Kokkos::deep_copy(space, _face_acceleration.component[sheet.axis], sheet.driving);
    Base::set_driving(space, sheet);
  }

  template <class T>
  [[nodiscard]] OwnFaces<T> faces_of(const std::string& label) const {
    OwnFaces<T> faces;
    for (int d = 0; d < 3; ++d) {
      const auto extent = [&](int axis) {
        return static_cast<std::size_t>(faces_along(_transfer.grid, d, axis));
      };
      faces.component[d] =
          Kokkos::View<T***, Kokkos::LayoutLeft, Memory>(label, extent(0), extent(1), extent(2));
    }
    return faces;
  }

  template <class View>
  [[nodiscard]] FaceArrays<const double> constant(const FaceViews<View>& faces) const {
    const auto arrays = face_arrays(_transfer.window, faces);
    FaceArrays<const double> result{};
    for (int d = 0; d < 3; ++d) {
      result.data[d] = arrays.data[d];
      for (int k = 0; k < 3; ++k) result.stride[d][k] = arrays.stride[d][k];
    }
    return result;
  }

  template <class Functor>
  void launch_faces(const ExecutionSpace& space, const char* label, Functor& functor) const {
    int extent[3] = {};
    for (int axis = 0; axis < 3; ++axis)
      for (int d = 0; d < 3; ++d) {
        functor.faces[d][axis] = faces_along(_transfer.grid, d, axis);
        extent[axis] = extent[axis] > functor.faces[d][axis] ? extent[axis] : functor.faces[d][axis];
      }
    device::launch_cells(space, label, extent, functor);
  }

  Kokkos::View<double* [9], Memory> _corner_force;
  OwnFaces<int> _count;
  OwnFaces<double> _before, _foretold;
  Kokkos::View<double* [1], Memory> _face_list;
  OwnFaces<double> _face_acceleration;  ///< in one list, of the air without the sheet, filtered, m/s^2
};

DROGUE_EXTERN_INSTANCES(class SharpSheet)

}  // namespace drogue::coupling
