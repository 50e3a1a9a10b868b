#pragma once

#include <array>

namespace drogue::reference {

/// Motion of a sheet along its normal in air at rest, in a mode that coupled steps do not mix with others:
/// one amplitude for all vertices.
struct SheetMode {
  double displacement = 0.0;  ///< m
  double velocity = 0.0;      ///< m/s
  double air = 0.0;           ///< velocity of the air, interpolated to the vertices, m/s
  double acceleration = 0.0;  ///< filtered acceleration of the air without the sheet, m/s^2
  double trend = 0.0;         ///< of it, per step, m/s^2
  double defect = 0.0;        ///< filtered difference of spreading and the copy of the air, m/s^2
};

/// Constants of a mode, those of the sheet per area.
struct SheetModeParameters {
  double mass = 1.0;       ///< of the sheet, kg/m^2
  double stiffness = 0.0;  ///< restoring pressure per displacement, Pa/m
  /// Change of a vertex's copy of the air per impulse per area, m^2/kg: the row sum, unless that is scaled.
  double inverse_air_mass = 1.0;
  /// Change of the interpolated velocity by spreading alone, m^2/kg; at most the row sum.
  double spread = 1.0;
  /// Such a change after a projection: the inverse of the added mass, m^2/kg; at most `spread`.
  double response = 1.0;
  /// Share of a copy's mass that the delta function adds to the added mass, if it is counted once: the copy
  /// is lighter by it, and the air receives what accelerates it beside the impulse of the sheet.
  double counted_once = 0.0;
  double alpha = 0.0;        ///< of a linear porous law, Pa s/m; infinite: impermeable
  double filter = 0.5;       ///< weight of the present step in the acceleration of the air
  double trend = 0.0;        ///< and of what it adds in the trend, which loses half of itself in a step
  double leak_filter = 0.0;  ///< and in the defect; 0: without it
  double smoothing = 1.0;    ///< factor of the means along the sheet that smooth the defect
  double dt = 0.01;          ///< of the flow, s
  int substeps = 1;          ///< of the sheet in each step of the flow
};

/// Step of a mode: in each substep, stiffness, acceleration, trend and defect change the velocities of sheet
/// and air, which then relax against each other by a step of the backward Euler method; the flow takes the
/// sum of the impulses. `is_first`: no step precedes this one.
[[nodiscard]] SheetMode coupled_step(const SheetMode& state, const SheetModeParameters& parameters,
                                     bool is_first = false);

/// Matrix by which a step multiplies a mode as velocities, m/s: displacement over dt, velocity, air, and
/// acceleration, trend and defect times dt.
using SheetModeMatrix = std::array<std::array<double, 6>, 6>;
[[nodiscard]] SheetModeMatrix amplification(const SheetModeParameters& parameters);

/// Largest magnitude of the eigenvalues of a matrix, by squaring it 30 times: the growth of a mode per step.
[[nodiscard]] double spectral_radius(SheetModeMatrix matrix);

}  // namespace drogue::reference
