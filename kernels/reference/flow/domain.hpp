#pragma once

#include <array>
#include <functional>
#include <vector>

#include "kernels/flow/parameters.hpp"

namespace drogue::reference {

using Point = std::array<double, 3>;
using GridIndex = std::array<int, 3>;

/// Velocity components at the faces normal to their axes, m/s, or another quantity there. Axis 0 varies
/// fastest.
using StaggeredField = std::array<std::vector<double>, 3>;

/// Velocity component on a side at a point (m) and a time (s), m/s. Sides: x low, x high, y low, y high, z
/// low, z high.
using SideVelocity =
    std::function<double(std::size_t side, std::size_t component, const Point& point, double time)>;

/// Box of cells with a staggered grid (Harlow and Welch 1965) and the conditions of its sides. Component c
/// has one face more than cells along its own axis if that is bounded.
class FlowDomain {
 public:
  /// Without `side_velocity` the velocities are those of the parameters.
  explicit FlowDomain(flow::Parameters parameters, SideVelocity side_velocity = {});

  [[nodiscard]] const flow::Parameters& parameters() const { return _parameters; }
  [[nodiscard]] int cells(std::size_t axis) const { return _parameters.cells[axis]; }
  /// Coordinate of a face of the cells, m: beyond bounded sides that of the mirror image.
  [[nodiscard]] double face_coordinate(std::size_t axis, int face) const;
  /// Coordinate of a component of the velocity, m.
  [[nodiscard]] double coordinate(std::size_t component, std::size_t axis, int face) const;
  /// Width of a cell, m; beyond sides as in `face_coordinate`.
  [[nodiscard]] double width(std::size_t axis, int cell) const;
  /// Distance between the centres of a cell and the one before it, m.
  [[nodiscard]] double distance(std::size_t axis, int cell) const;
  /// Width of the control volume of a component along an axis, m, and the distance of the component from that
  /// at the face before.
  [[nodiscard]] double extent(std::size_t component, std::size_t axis, int face) const;
  [[nodiscard]] double step(std::size_t component, std::size_t axis, int face) const;
  /// Volume of a cell, m^3.
  [[nodiscard]] double volume(const GridIndex& cell) const;
  [[nodiscard]] flow::BoundaryKind kind(std::size_t side) const { return _parameters.boundary[side].kind; }
  [[nodiscard]] bool is_bounded(std::size_t axis) const;

  /// Number of faces of a component along an axis.
  [[nodiscard]] int faces(std::size_t component, std::size_t axis) const;
  /// Position of a face in the array of its component.
  [[nodiscard]] std::size_t at(std::size_t component, const GridIndex& face) const;
  /// Position of a cell, axis 0 fastest.
  [[nodiscard]] std::size_t cell_at(const GridIndex& cell) const;

  [[nodiscard]] StaggeredField zero_field() const;
  /// Calls `visit(component, face)` for all faces in the order of their arrays.
  void for_each_face(const std::function<void(std::size_t, const GridIndex&)>& visit) const;
  void for_each_cell(const std::function<void(const GridIndex&)>& visit) const;

  /// Side on which a face of a component lies; -1 inside.
  [[nodiscard]] int side_of(std::size_t component, const GridIndex& face) const;
  /// Normal velocity on a side with a prescribed one, m/s, for a face of the component normal to it.
  [[nodiscard]] double normal_velocity(std::size_t side, const GridIndex& face, double time) const;

  /// Velocity at a face inside, on the sides, or up to three cells beyond a side, m/s.
  [[nodiscard]] double velocity(const StaggeredField& u, std::size_t component, const GridIndex& face,
                                double time) const;

 private:
  /// Prescribed velocity at a point of a side, m/s. Beyond the side it is repeated along periodic axes and
  /// continued linearly along others.
  [[nodiscard]] double side_velocity(std::size_t side, std::size_t component, const GridIndex& face,
                                     double time) const;

  flow::Parameters _parameters;
  SideVelocity _side_velocity;
};

/// Divergence at the cells, 1/s.
[[nodiscard]] std::vector<double> divergence(const FlowDomain& domain, const StaggeredField& u);

/// Gradient of a kinematic pressure that is zero on outflows, at the faces, m/s^2: zero on sides with a
/// prescribed normal velocity.
[[nodiscard]] StaggeredField pressure_gradient(const FlowDomain& domain, const std::vector<double>& pressure);

}  // namespace drogue::reference
