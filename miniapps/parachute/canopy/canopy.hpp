#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "kernels/fabric/parameters.hpp"
#include "miniapps/parachute/bodies/body.hpp"
#include "miniapps/parachute/flags/flag.hpp"

namespace drogue::parachute_app {

/// Kinds of canopies.
enum class CanopyKind {
  flat_circular,   ///< a flat disk of cloth with a vent
  extended_skirt,  ///< such a disk with a conical skirt
  guide_surface,   ///< likewise, with a skirt that guides the stream inwards to a narrow mouth
  sheet,           ///< a flat disk without lines and payload
  drum,            ///< such a disk under tension, whose rim is fixed
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

/// Drag of lines in the fluid: that of cylinders by the cross-flow principle.
struct CylinderDrag {
  double diameter = 0.004;   ///< m
  double coefficient = 1.1;  ///< of the flow across a line
  double friction = 0.02;    ///< of that along it, on the same area
};

/// Drag of a payload in the fluid, the same from all sides.
struct PayloadDrag {
  double area = 0.0;          ///< m^2
  double coefficient = 0.47;  ///< of a sphere
};

/// Suspension lines, one per gore, without mass unless given.
struct SuspensionLines {
  double length = 7.0;             ///< m, from the payload to the skirt
  double stiffness = 8000.0;       ///< E A, N
  double line_density = 0.0;       ///< kg/m; half of it moves with the skirt, half with the payload
  std::optional<double> strength;  ///< N, of each line
  std::optional<CylinderDrag> drag;
};

/// Point mass below the lines.
struct CanopyPayload {
  double mass = 100.0;               ///< kg
  bool fixed = false;                ///< it does not move
  bool guided = false;               ///< it moves along z alone
  std::array<double, 3> velocity{};  ///< m/s, at the start
  std::optional<double> release;     ///< s, at which the lines, or the riser, are cut
  std::optional<int> shared;         ///< number of the canopy that has the payload
  std::optional<PayloadDrag> drag;
};

/// Strap from the point where the lines meet to the payload.
struct Riser {
  double length = 0.0;     ///< m
  double stiffness = 1e5;  ///< E A, N
  double mass = 1.0;       ///< kg, at the point where the lines meet
};

/// Closed line through the skirt that keeps the mouth narrow until it is cut.
struct ReefingLine {
  double length = 0.0;        ///< m
  double stiffness = 8000.0;  ///< E A, N
  std::optional<double> cut;  ///< s
};

/// Lines across the vent, from seam to seam, which are tied where they cross.
struct VentLines {
  double stiffness = 8000.0;     ///< E A of each line, N
  double line_density = 0.0066;  ///< kg/m; half of it moves with the vent, half with the crossing
};

/// Conical skirt below the edge of the flat cloth.
struct ConicalSkirt {
  double length = 0.0;    ///< m, along the cloth
  double diameter = 0.0;  ///< m, of its lower edge
};

/// Random displacements of the cloth at the start.
struct Perturbation {
  double amplitude = 0.0;  ///< m, largest one, along the axis
  int seed = 0;
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
  ConicalSkirt skirt;   ///< of extended-skirt and guide-surface canopies
  Fabric cloth = Fabric::mil_c_7020_1;
  double area_density = 0.0373;       ///< kg/m^2; of a drum, under its tension
  double membrane_modulus = 20000.0;  ///< N/m
  double poisson = 0.3;
  double edge_length = 0.0;  ///< m, largest edge along the rings and the meridians
  CanopyShape shape = CanopyShape::flat;
  double closure = 0.5;  ///< radius of the skirt over that of the flat cloth, if partly closed
  double angle = 0.0;    ///< degrees, of the axis from z, unless the shape has its own
  double azimuth = 0.0;  ///< degrees, of the direction towards which the axis leans, from x towards y
  std::array<double, 3> centre{};  ///< m, of the skirt
  SuspensionLines lines;
  std::optional<Riser> riser;
  CanopyPayload payload;
  std::optional<ReefingLine> reefing;
  std::optional<VentLines> vent_lines;
  double tension = 0.0;     ///< N/m, of a drum
  double deflection = 0.0;  ///< m, of the centre of a drum at the start, along its axis
  Reinforcement reinforcement;
  Perturbation perturbation;
  std::array<double, 3>
      start_velocity{};  ///< of cloth, lines and payload, m/s: complete once the scene is read
  Porosity porosity = {PorosityLaw::forchheimer, 254.4, 37.6};

  /// Angle of the axis from z, degrees. Does not throw.
  [[nodiscard]] double axis_angle() const;
  /// True for kinds with a conical skirt. Does not throw.
  [[nodiscard]] bool has_skirt() const {
    return kind == CanopyKind::extended_skirt || kind == CanopyKind::guide_surface;
  }
  /// True for kinds with suspension lines and a payload. Does not throw.
  [[nodiscard]] bool has_lines() const { return kind != CanopyKind::sheet && kind != CanopyKind::drum; }
  /// Length of the cloth over that at rest: 1 unless it is under tension. Does not throw.
  [[nodiscard]] double stretch() const;
  /// Radius of the edge to which the lines are attached, in the cloth at rest, m. Does not throw.
  [[nodiscard]] double skirt_radius() const;
  /// Height of the flat cloth above that edge at rest, m; 0 without a conical skirt. Does not throw.
  [[nodiscard]] double skirt_height() const;
  /// Nominal area: that of the cloth and the vent, m^2. Does not throw.
  [[nodiscard]] double nominal_area() const;
  /// Diameter of a disk of the nominal area, m. Does not throw.
  [[nodiscard]] double nominal_diameter() const;
  /// Radius of the edge to which the lines are attached, at the start, m. Does not throw.
  [[nodiscard]] double starting_skirt_radius() const;
  /// Number of vertices, those of vent lines, a riser and an own payload included. Does not throw.
  [[nodiscard]] std::size_t vertices() const;
};

/// A canopy as a mesh, without its place in that of the scene.
struct CanopyMesh {
  /// After the cloth: where the vent lines cross, where the lines meet the riser, the payload unless shared.
  fabric::Parameters fabric;
  std::vector<fabric::Vector> positions;  ///< at the start, m
  std::size_t cloth_vertices = 0;         ///< they come first
  std::vector<int> skirt;                 ///< vertices to which the lines are attached, one per gore
  std::vector<int> vent_lines, reefing, suspension;  ///< numbers of lines
  std::optional<int> riser;                          ///< line to an own payload
};

/// Rows of a canopy in the vectors of the solver.
struct CanopyRows {
  std::size_t begin = 0, cloth_end = 0, end = 0;  ///< vertices, those of the cloth first
  std::optional<std::size_t> vent_crossing;       ///< where the vent lines cross
  std::optional<std::size_t> payload;             ///< perhaps of an earlier canopy
  std::size_t triangles_begin = 0, triangles_end = 0;
  std::vector<int> reefing, suspension;  ///< numbers of lines
  std::optional<int> riser;
  std::size_t line_drag = 0, payload_drag = 0;  ///< first in `Sheets::line_drag`, and in `vertex_drag`

  /// Part of the canopy that a vertex belongs to: "cloth", "vent lines", "payload" or "riser". Does not
  /// throw.
  [[nodiscard]] const char* part_of(std::size_t vertex) const;
};

/// All sheets of a scene as one fabric.
struct Sheets {
  fabric::Parameters fabric;
  std::vector<fabric::Vector> positions;   ///< at the start, m
  std::vector<fabric::Vector> velocities;  ///< at the start, m/s
  std::vector<coupling::PorousLaw> laws;   ///< one per vertex
  std::vector<CanopyRows> canopies;
  std::vector<FlagRows> flags;
  std::vector<coupling::LineCut> cuts;  ///< of reefing lines, and of lines to payloads
  std::vector<coupling::LineDrag> line_drag;
  std::vector<coupling::VertexDrag> vertex_drag;
  std::vector<double> line_strength;  ///< N, of every line of the mesh; infinite: no limit
};

/// Place of the payload at the start, m. Does not throw.
[[nodiscard]] fabric::Vector payload_place(const Canopy& canopy);

/// Sets the centres of canopies that share the payload of an earlier one, so that their lines and risers are
/// straight at the start. Does not throw.
void place_at_shared_payloads(std::vector<Canopy>& canopies);

/// Numbers of vertices of the rings of a canopy from the vent or the centre to the skirt. Each is a multiple
/// of the number of gores or divides it, unless it has no divisor that keeps edges above a third of
/// `edge_length`. Does not throw.
[[nodiscard]] std::vector<int> ring_sizes(const Canopy& canopy);

/// Mesh, masses, lines and payload of a canopy. At rest the cloth has its constructed shape, with the edge of
/// the skirt in the plane through the centre, and the lines just reach it; `positions` are those of its
/// shape. A drum is smaller at rest by its stretch, and starts in its first axisymmetric mode in vacuum.
/// Throws std::invalid_argument for parameters out of range.
[[nodiscard]] CanopyMesh make_canopy(const Canopy& canopy);

/// The bodies, then the canopies, then the flags, in a fluid of given density, kg/m^3, and viscosity, Pa s.
/// Throws std::invalid_argument for parameters out of range.
[[nodiscard]] Sheets make_all_sheets(const std::vector<Body>& bodies, const std::vector<Canopy>& canopies,
                                     double density, double viscosity, const std::vector<Flag>& flags = {});

}  // namespace drogue::parachute_app
