#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"

namespace drogue::parachute_app {

/// Kinds of bodies.
enum class BodyKind {
  plate,     ///< rectangle normal to an axis
  disk,      ///< circular plate normal to an axis
  sphere,    ///< closed
  cylinder,  ///< about an axis, with or without its ends; a circle in two dimensions
  cup,       ///< half of a sphere, open along an axis
  file,      ///< of a mesh file
};

/// Laws of the flow through a sheet.
enum class PorosityLaw {
  none,         ///< impermeable
  forchheimer,  ///< pressure difference alpha w + beta |w| w at the normal velocity w
  ergun,        ///< the same with alpha and beta of a packed bed, Ergun 1952
  kim_peskin,   ///< the same with alpha of pores of a given conductance, beta = 0; Kim and Peskin 2006
};

struct Porosity {
  PorosityLaw law = PorosityLaw::none;
  // Measured on cloth MIL-C-7020 type III.
  double alpha = 254.4;  ///< Pa s/m
  double beta = 37.6;    ///< Pa s^2/m^2
  // Packed bed of Ergun.
  double void_fraction = 0.0;
  double thickness = 0.0;  ///< m
  double grain = 0.0;      ///< diameter of the grains or threads, m
  // Pores of Kim and Peskin.
  double pores = 0.0;        ///< per area, 1/m^2
  double conductance = 0.0;  ///< flow rate through a pore per pressure difference, m^3/(Pa s)
};

/// Spring along the normal of a plate that moves freely along it.
struct Mount {
  double mass = 0.0;       ///< kg, of the plate
  double stiffness = 0.0;  ///< N/m
  double offset = 0.0;     ///< displacement at the start, m
};

/// Rigid sheet immersed in the flow, at rest, in prescribed motion, or a plate on a spring.
struct Body {
  BodyKind kind = BodyKind::plate;
  int axis = 0;                       ///< normal of a plate or disk; axis of a cylinder or cup
  std::array<double, 3> centre{};     ///< m
  std::array<double, 2> lengths{};    ///< m, of a plate along the other axes in ascending order
  double hole = 0.0;                  ///< radius of a round hole in the middle of a square plate, m; 0: none
  double radius = 0.0;                ///< m, of others
  double length = 0.0;                ///< m, of a cylinder
  bool has_ends = false;              ///< of a cylinder: disks close it
  bool opens_to_high = false;         ///< a cup is open towards the high side of its axis
  double edge_length = 0.0;           ///< m, of the triangles
  double retraction = 0.0;            ///< cells by which a sphere, cylinder or cup is smaller
  std::array<double, 3> spacing{};    ///< m, of the cells, in which a retraction is measured
  std::string file;                   ///< Wavefront OBJ
  double scale = 1.0;                 ///< m per unit of length of the file
  mesh::Mesh surface;                 ///< of the file, m; its origin is at `centre`
  std::array<std::string, 3> motion;  ///< displacement, m, as expressions of t; empty: none
  std::optional<bool> slip;           ///< the fluid slips freely along the sheet
  Porosity porosity;
  std::optional<Mount> mount;

  /// The two axes along a plate, ascending. Does not throw.
  [[nodiscard]] std::array<std::size_t, 2> axes() const;

  /// Numbers of divisions: edges of a plate along these axes, or columns and rows around its hole; rings of a
  /// disk or cup; divisions of a sphere; columns, or rings of ends, and rows of a cylinder; none of a file.
  /// Does not throw.
  [[nodiscard]] std::array<double, 2> divisions() const;

  /// Number of vertices. Does not throw.
  [[nodiscard]] double vertices() const;

  /// Largest edge, m: the given one, or that of the file. Does not throw.
  [[nodiscard]] double largest_edge() const;

  /// Distance by which the retraction shortens the body along an axis from its centre, m; 0 along an open
  /// cylinder. Does not throw.
  [[nodiscard]] double shortened_by(std::size_t along) const;

  /// Largest distances from the centre along each axis to the low and the high side, m, of the body without
  /// its retraction. Does not throw.
  [[nodiscard]] std::array<std::array<double, 2>, 3> extents() const;

  [[nodiscard]] bool moves() const;
  /// `slip`; by default, true for flat sheets. Does not throw.
  [[nodiscard]] bool slips() const;
};

/// Largest distance of vertices in cells at which a sheet does not leak: 1 / 1.4. Shown by
/// `FixedSheet.FollowsThePorousLawAtAnySlope` at half a cell.
inline constexpr double largest_edge_in_cells = 1.0 / 1.4;

/// Largest number of vertices of a sheet.
inline constexpr double most_vertices = 1048576.0;  // 2^20

/// Number of vertices of all bodies. Does not throw.
[[nodiscard]] std::size_t vertices_of(const std::vector<Body>& bodies);

/// Triangles of a body at time 0 without its motion, inside of it by its retraction: a sheet of smoothed
/// delta functions acts on the fluid as one farther outwards (Breugem, J. Comput. Phys. 231:4469, 2012).
/// Throws only std::bad_alloc.
[[nodiscard]] mesh::Mesh mesh_of(const Body& body);

/// The bodies as one cloth with their motions, then the fixed ends of springs. All vertices are pinned, those
/// of plates with a mount only along their tangents. Throws std::bad_alloc, and std::invalid_argument for the
/// expression of a motion that is too long.
[[nodiscard]] fabric::Parameters make_sheets(const std::vector<Body>& bodies);

/// Displaces plates with a mount, whose vertices begin `positions`, m, to where they start. Does not throw.
void set_offsets(const std::vector<Body>& bodies, std::vector<fabric::Vector>& positions);

/// Law of the sheet for the solver, in a fluid of given density, kg/m^3, and viscosity, Pa s. Does not throw.
[[nodiscard]] coupling::PorousLaw law_of(const Porosity& porosity, double density, double viscosity);

}  // namespace drogue::parachute_app
