#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/fabric/parameters.hpp"
#include "miniapps/parachute/bodies/body.hpp"

namespace drogue::parachute_app {

/// Kinds of canopies.
enum class CanopyKind {
  flat_circular,  ///< a flat disk of cloth with a vent
};

/// Kinds of cloth.
enum class Fabric {
  mil_c_7020_1,  ///< MIL-C-7020 type I: 0.0373 kg/m^2
  custom,        ///< of a given area density
};

/// Shapes at the start.
enum class CanopyShape {
  flat,           ///< the flat disk
  partly_closed,  ///< a pleated cone
  angled_15,      ///< the flat disk, its axis 15 degrees from z
  angled_60,
  angled_75,
};

/// Suspension lines, one per gore, without mass unless given.
struct SuspensionLines {
  double length = 7.0;        ///< m, from the payload to the skirt
  double stiffness = 8000.0;  ///< E A, N
  double line_density = 0.0;  ///< kg/m; half of it moves with the skirt, half with the payload
};

/// Point mass below the lines.
struct CanopyPayload {
  double mass = 100.0;  ///< kg
  bool fixed = false;   ///< it does not move
};

/// E A of bands sewn along edges of the cloth, N; zero: none.
struct Reinforcement {
  double seams = 0.0, skirt = 0.0, vent = 0.0;
};

/// Parachute with its lines and payload. The defaults are those of a C-9.
struct Canopy {
  CanopyKind kind = CanopyKind::flat_circular;
  double diameter = 8.534;  ///< m, of the flat cloth
  int gores = 28;
  double vent = 0.457;  ///< m, diameter; 0: none
  Fabric cloth = Fabric::mil_c_7020_1;
  double area_density = 0.0373;       ///< kg/m^2
  double membrane_modulus = 20000.0;  ///< N/m
  double poisson = 0.3;
  double edge_length = 0.0;  ///< m, largest edge along the rings and the meridians
  CanopyShape shape = CanopyShape::flat;
  double closure = 0.5;            ///< radius of the skirt over that of the flat cloth, if partly closed
  double angle = 0.0;              ///< degrees, of the axis from z towards x, unless the shape has its own
  std::array<double, 3> centre{};  ///< m, of the skirt
  SuspensionLines lines;
  CanopyPayload payload;
  Reinforcement reinforcement;
  Porosity porosity = {PorosityLaw::forchheimer, 254.4, 37.6};

  /// Angle of the axis from z, degrees. Does not throw.
  [[nodiscard]] double axis_angle() const;
  /// Nominal area, which includes the vent, m^2. Does not throw.
  [[nodiscard]] double nominal_area() const;
  /// Number of vertices, the payload included. Does not throw.
  [[nodiscard]] std::size_t vertices() const;
};

/// A canopy as a mesh, without its place in that of the scene.
struct CanopyMesh {
  fabric::Parameters fabric;              ///< the payload is the last vertex
  std::vector<fabric::Vector> positions;  ///< at the start, m
  std::size_t cloth_vertices = 0;         ///< they come first
  std::vector<int> skirt;                 ///< vertices to which the lines are attached, one per gore
};

/// Rows of a canopy in the vectors of the solver.
struct CanopyRows {
  std::size_t begin = 0, payload = 0;  ///< cloth: [begin, payload)
  std::size_t triangles_begin = 0, triangles_end = 0;
};

/// All sheets of a scene as one fabric.
struct Sheets {
  fabric::Parameters fabric;
  std::vector<fabric::Vector> positions;  ///< at the start, m
  std::vector<coupling::PorousLaw> laws;  ///< one per vertex
  std::vector<CanopyRows> canopies;
};

/// Numbers of vertices of the rings of a canopy from the vent or the centre to the skirt. Each divides or is
/// a multiple of the number of gores. Does not throw.
[[nodiscard]] std::vector<int> ring_sizes(const Canopy& canopy);

/// Mesh, masses, lines and payload of a canopy. At rest the cloth is flat in its plane through the centre,
/// and the lines just reach its skirt; `positions` are those of its shape. Throws std::invalid_argument for
/// parameters out of range.
[[nodiscard]] CanopyMesh make_canopy(const Canopy& canopy);

/// The bodies, then the canopies, in a fluid of given density, kg/m^3, and viscosity, Pa s. Throws
/// std::invalid_argument for parameters out of range.
[[nodiscard]] Sheets make_all_sheets(const std::vector<Body>& bodies, const std::vector<Canopy>& canopies,
                                     double density, double viscosity);

}  // namespace drogue::parachute_app
