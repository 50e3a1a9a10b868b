#pragma once

#include <array>
#include <vector>

#include "kernels/coupling/parameters.hpp"

namespace drogue::coupling {

/// Pressure difference across a porous sheet, Pa, for the normal velocity w of the sheet relative to the air,
/// m/s: alpha w + beta |w| w.
struct PorousLaw {
  double alpha = 0.0;        ///< Pa s/m, >= 0
  double beta = 0.0;         ///< Pa s^2/m^2, >= 0
  bool impermeable = false;  ///< no flow through the sheet; alpha and beta are ignored
  bool no_slip = false;  ///< the air has the velocity of the sheet along its tangents; else no shear stress
};

/// Running mean of the acceleration of the air at a vertex.
struct AirFilter {
  double weight = 0.5;  ///< of the present step, 0 to 1
  bool by_law = false;  ///< `weight` does not count, but that of `FilterWeights` for the law of the vertex
};

/// Coupling of sheets to the air. The first two give prescribed motion the same forces.
enum class CouplingMethod {
  spread,  ///< cloth and air relax against each other in each step of the cloth; cloth of any mass
  /// The force of the last step of the flow acts on the cloth, which then imposes its velocity on the air:
  /// explicit staggered coupling ([Shi], section 3.3.2), unstable for light cloth.
  explicit_,
  sharp,  ///< pressure jumps between the cells that a sheet in prescribed motion separates (`SharpSheet`)
};

/// Plane sheet in prescribed motion, normal to an axis, that closes a channel along it, so that all of the
/// air there has one mean velocity.
struct ClosingSheet {
  int axis = 0;
  int begin = 0, end = 0;  ///< its vertices, which have one law
  /// Change of the mean velocity by an impulse per area of the sheet, m^2/kg: 1 / (density length) of the
  /// channel, or 0 where its sides prescribe the flow rate.
  double inverse_mass = 0.0;
  double driving = 0.0;  ///< acceleration of the air by body force and pressure drop at the start, m/s^2
};

/// Parameters of the exchange between a sheet and the air.
struct SheetParameters {
  DeltaFunction delta = DeltaFunction::cbs43;
  PorousLaw law;
  std::vector<PorousLaw> law_of_vertex;  ///< one per vertex, or empty: `law` for all
  /// Weight of the present step in the running mean of the acceleration of the air, 0 to 1. With 0 for this
  /// and for `leak_filter` the energy cannot grow, but the sheet leaks in proportion to dt; nearly
  /// impermeable sheets need 0.2 or less if dt exceeds the period of their oscillations over 2 pi.
  double filter = 0.5;
  std::vector<AirFilter> filter_of_vertex;  ///< one per vertex, or empty: `filter` for all
  /// Weight of the present step in the running mean of the defect, smoothed along the sheet: of what
  /// spreading and interpolation give the air at a vertex, less the row sum times its impulse. 0: without it,
  /// so that curved and folded sheets leak in proportion to dt. For `CouplingMethod::spread` alone.
  double leak_filter = 0.0;
  /// Cells by which free edges lie farther inwards where the sheet exchanges forces with the air, 0 to 1:
  /// `EdgeInset`. With `DeltaFunction::cbs43`, 0.55 takes most of the error of drag away, which is of first
  /// order in the cells with 0. Not for `CouplingMethod::sharp`.
  double edge_inset = 0.0;
  CouplingMethod method = CouplingMethod::spread;
  /// Sheets that close a channel. Along an axis, one of them at most is impermeable, and none where
  /// `inverse_mass` is 0.
  std::vector<ClosingSheet> closing;
};

/// Vertex with its weight in a mean.
struct WeightedVertex {
  int vertex = 0;
  double weight = 1.0;
};

/// Frame of reference that follows a point of the cloth, such as a payload, so that the point stays in the
/// grid. The frame keeps its velocity during a block of steps, so that it is inertial there.
struct FollowParameters {
  /// Vertices whose weighted mean is the point, few of them; none: the frame is at rest. The weights add up
  /// to 1.
  std::vector<WeightedVertex> vertices;
  std::array<bool, 3> axes{};     ///< along which it moves; no walls or slip sides are normal to them
  std::array<double, 3> place{};  ///< in the grid to which the point returns, m
  /// s; at the beginning of a block, the velocity of the point becomes minus its distance from `place` over
  /// this time, or over the duration of the block if that is longer.
  double relaxation = 1.0;
};

/// Lines that are cut at a time: from then on they have no stiffness.
struct LineCut {
  double time = 0.0;       ///< s, > 0
  std::vector<int> lines;  ///< numbers in the mesh of the cloth
};

/// Drag of a straight line of the mesh in the air by the cross-flow principle: each component of the velocity
/// of the air relative to the line, along it and across it, has a force per length of half the density times
/// the square of the component. Lines that are cut have none.
struct LineDrag {
  int line = 0;         ///< number in the mesh
  double across = 0.0;  ///< drag coefficient of the flow across the line times diameter, m
  double along = 0.0;   ///< the same of the flow along it, m
};

/// Drag of a body at a vertex, without reaction on the air: its wake would be as wide as some cells.
struct VertexDrag {
  int vertex = 0;
  double area = 0.0;  ///< drag coefficient times area, m^2
};

}  // namespace drogue::coupling
