#pragma once

#include <algorithm>

#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/boundary/conditions.hpp"

namespace drogue::flow {

/// Predicted velocity on the sides, after the momentum stage, with its factors.
///
/// Normal components: prescribed values, and at outflows the momentum equation, with advection of first order
/// and upwind, or central as that of the cells, so that vortices leave with the flow. The pressure on the
/// face is part of the rate: the projection adds a pressure that is zero there. The rate of a low face is
/// kept in the ghost cell below it, because the momentum stage overwrites the rate at the face itself.
///
/// Tangential components beside outflows: the momentum stage has carried in the velocity inside where fluid
/// enters; here it becomes that of the fluid outside.
///
/// Kinetic energy, with half of a cell at each face on a side, does not grow between outflows of fluid at
/// rest: with the outward velocities a inside and u on the face, central advection adds nothing where fluid
/// enters, and -u ((a - u)^2 + 2 u^2) / 4 per area where it leaves.
template <class ExecutionSpace, bool is_stretched>
struct BoundaryFacesFunctor {
  MomentumSetup<ExecutionSpace> setup;
  BoundaryConditions<ExecutionSpace> boundary;
  bool upwind;        ///< advection of the normal velocity on outflows; else central
  int side_faces[6];  ///< 0 for periodic sides and neighbours

  KOKKOS_FUNCTION void operator()(int face) const {
    if (setup.control().trial.stop != stepping::Stop::running) return;
    predict(widths_of<is_stretched>(setup.grid), face);
  }

 private:
  template <class Widths>
  KOKKOS_FUNCTION void predict(const Widths& widths, int face) const {
    const MacGrid& g = setup.grid;
    int side = 0;
    while (face >= side_faces[side]) face -= side_faces[side++];
    using Conditions = BoundaryConditions<ExecutionSpace>;
    const int axis = side / 2, a = Conditions::first_axis(axis), b = Conditions::second_axis(axis);
    int cell[3];
    cell[axis] = side % 2 == 1 ? g.n[axis] - 1 : 0;
    cell[a] = face % g.n[a];
    cell[b] = face / g.n[a];
    if (boundary.kind[side] == BoundaryKind::outflow) {
      const StageFactors factors = stage_factors(setup, setup.control());
      advance_outflow(widths, side, cell, factors);
      carry_in(widths, side, cell, factors);
    } else {
      setup.out(place_of(side, cell)) =
          boundary.kind[side] == BoundaryKind::slip ? 0.0 : boundary.value(g, side, axis, cell);
    }
  }

  /// Place of the face of a cell on a side.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t place_of(int side, const int cell[3]) const {
    const MacGrid& g = setup.grid;
    const int axis = side / 2;
    return axis * g.component + g.offset(cell[0], cell[1], cell[2]) + (side % 2) * g.stride[axis];
  }

  template <class Widths>
  KOKKOS_FUNCTION void advance_outflow(const Widths& widths, int side, const int cell[3],
                                       const StageFactors& f) const {
    const MacGrid& g = setup.grid;
    const int axis = side / 2;
    const bool high = side % 2 == 1;
    const std::int64_t place = place_of(side, cell), inward = high ? -g.stride[axis] : g.stride[axis];
    const double value = setup.stage(place), outward = high ? value : -value;
    const double inner = setup.stage(place + inward), mean = 0.5 * (value + inner);
    // Where fluid enters, upwind advection has nothing to carry from inside, and central fluxes have a mean.
    const double speed = outward > 0.0 ? outward : upwind ? 0.0 : high ? mean : -mean;
    const double inverse_width = widths.inverse_width(axis, cell[axis]);
    double rate = setup.acceleration[axis] - speed * inverse_width * (value - inner);
    if (outward < 0.0) {
      const double push = 2.0 * inverse_width * entering_pressure(side, outward);
      rate += high ? -push : push;
    }
    for (int end = 0; end < 6; ++end)
      if (end / 2 != axis && g.n[end / 2] > 1) rate += advection_from(widths, end, side, cell, value);
    double next = value + f.rate * rate;
    if (setup.weights.adams_bashforth) {
      const std::int64_t kept = high ? place : place - g.stride[axis];
      next += f.old_rate * setup.old_rate(kept);
      setup.old_rate(kept) = rate;
    } else {
      next += f.state * (setup.state(place) - value);
    }
    if (setup.force.data() != nullptr) next += f.force * setup.force(place);
    setup.out(place) = next;
  }

  /// Kinematic pressure on the face of an outflow where fluid enters, (V^2 - u^2) / 2, m^2/s^2, for the
  /// outward velocity u; V is that of the fluid outside, or zero if that leaves. So the total pressure is
  /// that of the fluid outside.
  [[nodiscard]] KOKKOS_FUNCTION double entering_pressure(int side, double outward) const {
    const double velocity = boundary.velocity[side][side / 2];
    const double outside = Kokkos::fmin(0.0, side % 2 == 1 ? velocity : -velocity);
    return 0.5 * (outside * outside - outward * outward);
  }

  /// Rate of change of the normal velocity on a side by advection along the side, m/s^2, through the end
  /// `end` (numbered as sides) of the cell.
  template <class Widths>
  [[nodiscard]] KOKKOS_FUNCTION double advection_from(const Widths& widths, int end, int side,
                                                      const int cell[3], double value) const {
    const MacGrid& g = setup.grid;
    const std::int64_t outward = (end % 2 == 1 ? 1 : -1) * g.stride[end / 2];
    const double speed = setup.stage(place_of(end, cell)), inward = end % 2 == 1 ? -speed : speed;
    const double inverse_width = widths.inverse_width(end / 2, cell[end / 2]);
    if (is_beside_outflow(end, cell))
      return inward > 0.0 ? inward * inverse_width * (boundary.velocity[end][side / 2] - value) : 0.0;
    const double weight = !upwind ? 0.5 * inward : inward > 0.0 ? inward : 0.0;
    return weight * inverse_width * (setup.stage(place_of(side, cell) + outward) - value);
  }

  /// True for the outermost cells beside an outflow.
  [[nodiscard]] KOKKOS_FUNCTION bool is_beside_outflow(int side, const int cell[3]) const {
    const int outermost = side % 2 == 1 ? setup.grid.n[side / 2] - 1 : 0;
    return side_faces[side] > 0 && boundary.kind[side] == BoundaryKind::outflow &&
           cell[side / 2] == outermost;
  }

  /// Replaces the tangential momentum that enters the control volumes at the low faces of a cell. That at an
  /// edge between outflows is treated once, for all of them.
  template <class Widths>
  KOKKOS_FUNCTION void carry_in(const Widths& widths, int side, const int cell[3],
                                const StageFactors& f) const {
    const MacGrid& g = setup.grid;
    for (int c = 0; c < 3; ++c) {
      if (c == side / 2 || (cell[c] == 0 && side_faces[2 * c] > 0)) continue;
      double rate = 0.0;
      bool is_first = true;
      for (int other = 0; other < 6; ++other) {
        if (other / 2 == c || !is_beside_outflow(other, cell)) continue;
        is_first = is_first && other >= side;
        rate += carried_rate(widths, other, c, cell);
      }
      if (!is_first || rate == 0.0) continue;
      const std::int64_t place = c * g.component + g.offset(cell[0], cell[1], cell[2]);
      setup.out(place) += f.rate * rate;
      if (setup.weights.adams_bashforth) setup.old_rate(place) += rate;
    }
  }

  /// Change of the rate of component c, m/s^2, where fluid enters its control volume through a side: with the
  /// velocity outside in place of that inside.
  template <class Widths>
  [[nodiscard]] KOKKOS_FUNCTION double carried_rate(const Widths& widths, int side, int c,
                                                    const int cell[3]) const {
    const MacGrid& g = setup.grid;
    const std::int64_t face = place_of(side, cell), before = face - (g.n[c] > 1 ? g.stride[c] : 0);
    double mean = 0.5 * (setup.stage(before) + setup.stage(face));
    if constexpr (!Widths::are_equal) mean += g.skew(c, cell[c]) * (setup.stage(face) - setup.stage(before));
    const double outward = side % 2 == 1 ? mean : -mean;
    const double inside = setup.stage(c * g.component + g.offset(cell[0], cell[1], cell[2]));
    const double inverse_width = widths.inverse_width(side / 2, cell[side / 2]);
    return outward < 0.0 ? -outward * inverse_width * (boundary.velocity[side][c] - inside) : 0.0;
  }
};

/// Enqueues the predicted velocity on the sides, after the momentum stage. Asynchronous.
template <class ExecutionSpace>
void launch_boundary_faces(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                           const BoundaryConditions<ExecutionSpace>& boundary, Advection advection) {
  const MacGrid& g = setup.grid;
  int total = 0, side_faces[6] = {};
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    if (g.periodic[axis] || g.n[axis] == 1 || boundary.kind[side] == BoundaryKind::neighbour) continue;
    side_faces[side] = g.n[(axis + 1) % 3] * g.n[(axis + 2) % 3];
    total += side_faces[side];
  }
  if (total == 0) return;
  launch_for_widths(g, [&]<bool is_stretched>() {
    BoundaryFacesFunctor<ExecutionSpace, is_stretched> functor{setup, boundary, is_upwind(advection), {}};
    std::copy_n(side_faces, 6, functor.side_faces);
    device::launch_each(space, "drogue::flow::boundary_faces", total, functor);
  });
}

}  // namespace drogue::flow
