#pragma once

#include <span>

#include "kernels/fabric/results.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"

namespace drogue::parachute_app {

/// State of all sheets at one time, one vector per vertex.
struct SheetState {
  std::vector<fabric::Vector> positions;   ///< m
  std::vector<fabric::Vector> velocities;  ///< m/s
  std::vector<fabric::Vector> on_air;      ///< forces on the air in the last step, N
  std::vector<fabric::Vector> elastic;     ///< elastic forces, N
  std::vector<fabric::Vector> drag;        ///< of lines, then of payloads, in the last step, N
  std::vector<fabric::Vector> air;         ///< velocities of the air at the positions, m/s; empty without air
};

/// Measures of a canopy.
struct CanopyMeasures {
  fabric::Vector force{};       ///< of the air on the cloth, N
  fabric::Vector line_force{};  ///< of the lines or the riser on the payload, N
  fabric::Vector payload{};     ///< m; of the centre of mass of a sheet without payload
  fabric::Vector velocity{};    ///< of the payload, or of that centre, m/s
  double projected_area = 0.0;  ///< on a plane normal to z, m^2
  double leak = 0.0;            ///< `leak_through`, m^3/s; 0 without air
  double largest_strain = 0.0;  ///< of an edge of the cloth; 0 if all are slack
  /// Share of the lines at whose vertex of the skirt the side of the cloth that was constructed outside faces
  /// inwards, to a quarter of the way from the centre of mass of the cloth to the point where the lines meet:
  /// a place within an open canopy, and below a flat one. 0 without lines.
  double inversion = 0.0;
  double lean =
      0.0;  ///< angle between z and the axis from the payload to the skirt, degrees; 0 without lines
};

/// Area of the shadow that triangles cast along z, m^2, counted once where they overlap: by the centres of
/// squares whose side is 1/256 of the larger extent. Throws only std::bad_alloc.
[[nodiscard]] double projected_area(std::span<const fabric::Vector> positions,
                                    std::span<const std::array<int, 3>> triangles);

/// Volume flow of the air through triangles, relative to them, m^3/s: the integral of its relative velocity,
/// linear within each triangle, along their normals. From the inside of a canopy as constructed it is
/// positive. Does not throw.
[[nodiscard]] double leak_through(std::span<const std::array<int, 3>> triangles, const SheetState& state);

/// `CanopyMeasures::lean`. Does not throw.
[[nodiscard]] double lean_of(const CanopyRows& rows, const fabric::Mesh& mesh,
                             std::span<const fabric::Vector> positions);

/// Measures of a canopy in the mesh of all sheets. `released`: its payload has been released. Throws only
/// std::bad_alloc.
[[nodiscard]] CanopyMeasures measure(const CanopyRows& rows, const fabric::Parameters& sheets,
                                     const SheetState& state, bool released);

/// Drag coefficient 2 F / (rho U^2 S) of a force, N, whose component along U, the velocity of the fluid
/// relative to the payload, m/s, is F; rho: density, kg/m^3; S: area, m^2. 0 if F is 0. Does not throw.
[[nodiscard]] double drag_coefficient(const fabric::Vector& force, const fabric::Vector& velocity,
                                      double density, double area);

/// Lines that pull on the payload of each canopy, whose force is `CanopyMeasures::line_force`; none of a
/// sheet without payload. Throws only std::bad_alloc.
[[nodiscard]] std::vector<fabric::Pull> pulls_on_payloads(const Sheets& sheets);

/// Magnitude of the sum of a total force on the air, N, and the reactions to the forces of the vertices on
/// it, relative to the sum of the magnitudes of these. Does not throw.
[[nodiscard]] double force_balance(const fabric::Vector& total_on_air,
                                   std::span<const fabric::Vector> on_air);

}  // namespace drogue::parachute_app
