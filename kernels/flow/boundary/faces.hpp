#pragma once

#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/boundary/conditions.hpp"

namespace drogue::flow {

/// Normal components of the predicted velocity on the sides: prescribed values, and at outflows the momentum
/// equation with advection by the outward velocity, first order and upwind, so that vortices leave with the
/// flow. The projection adds the pressure. Advances with the factors of the momentum stage. The rate of a low
/// face is kept in the ghost cell below it, because the momentum stage overwrites the rate at the face
/// itself.
template <class ExecutionSpace>
struct BoundaryFacesFunctor {
  MomentumSetup<ExecutionSpace> setup;
  BoundaryConditions<ExecutionSpace> boundary;
  int side_faces[6];  ///< 0 for periodic sides and neighbours

  KOKKOS_FUNCTION void operator()(int face) const {
    const Control& control = setup.control();
    if (control.trial.stop != stepping::Stop::running) return;
    const MacGrid& g = setup.grid;
    int side = 0;
    while (face >= side_faces[side]) face -= side_faces[side++];
    using Conditions = BoundaryConditions<ExecutionSpace>;
    const int axis = side / 2, a = Conditions::first_axis(axis), b = Conditions::second_axis(axis);
    const bool high = side % 2 == 1;
    int index[3];
    index[axis] = high ? g.n[axis] : 0;
    index[a] = face % g.n[a];
    index[b] = face / g.n[a];
    const std::int64_t place = axis * g.component + g.offset(index[0], index[1], index[2]);
    if (boundary.kind[side] == BoundaryKind::outflow) {
      const std::int64_t inward = high ? -g.stride[axis] : g.stride[axis];
      const double value = setup.stage(place), outward = high ? value : -value;
      const double speed = outward > 0.0 ? outward : 0.0;
      const double rate =
          setup.acceleration[axis] - speed * g.inverse_h[axis] * (value - setup.stage(place + inward));
      const StageFactors f = stage_factors(setup, control);
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
    } else {
      setup.out(place) =
          boundary.kind[side] == BoundaryKind::slip ? 0.0 : boundary.value(g, side, axis, index);
    }
  }
};

/// Enqueues the boundary faces of the predicted velocity, after the momentum stage. Asynchronous.
template <class ExecutionSpace>
void launch_boundary_faces(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                           const BoundaryConditions<ExecutionSpace>& boundary) {
  BoundaryFacesFunctor<ExecutionSpace> functor{setup, boundary, {}};
  const MacGrid& g = setup.grid;
  int total = 0;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    if (g.periodic[axis] || g.n[axis] == 1 || boundary.kind[side] == BoundaryKind::neighbour) continue;
    functor.side_faces[side] = g.n[(axis + 1) % 3] * g.n[(axis + 2) % 3];
    total += functor.side_faces[side];
  }
  if (total > 0) device::launch_each(space, "drogue::flow::boundary_faces", total, functor);
}

}  // namespace drogue::flow
