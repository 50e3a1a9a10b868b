#pragma once

#include "kernels/fabric/contact/narrow_phase.hpp"

namespace drogue::fabric {

// Impulses at the beginning of a step, or on the mean velocities in an interval: projected Jacobi rounds, in
// which each of the n constraints of a vertex has 1/n of its mass (mass splitting, Tonge, Benevolenski and
// Voroshilov 2012). Impulses act between the vertices of a constraint by their weights, so momentum is
// conserved. They add energy only by separating parts nearer than the thickness, at most the normal impulse
// times `target_velocity`, whose bound does not depend on dt, and by the friction that balances a kick
// (`set_friction_target`).

/// Impulse of a constraint on the vertex in one of its slots, kg m/s.
KOKKOS_INLINE_FUNCTION Point impulse_on(const ContactConstraint& constraint, int slot, double normal_impulse,
                                        const Point& friction_impulse) {
  const Point lever = lever_of(constraint, is_edge_edge(constraint), slot);
  return constraint.weight[slot] * (normal_impulse * constraint.normal + friction_impulse) +
         dot(lever, friction_impulse) * constraint.normal;
}

/// Unit of the integers of `ImpulseSum` of vertex i, kg m/s, for sums up to 2048 times its momentum at the
/// largest speed: 1e-16 of that is the error of an impulse. Of a vertex with n constraints and split masses,
/// impulses change the velocity by sqrt(n M / m) / 2 times the relative velocity at most, with its mass m and
/// the effective mass M of its partners.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION double impulse_quantum(const ContactViews<ExecutionSpace>& views, int i) {
  const ContactStatus& progress = views.progress(0);
  return 0x1p-52 * (progress.speed + max_recovery * views.thickness / progress.dt) / views.inverse_mass(i);
}

/// Adds an impulse, kg m/s, to a sum of multiples of `quantum`, kg m/s. One beyond the range of the sum,
/// which is not finite, is left out.
KOKKOS_INLINE_FUNCTION void add_impulse(std::int64_t (&sum)[3], const Point& impulse, double quantum) {
  const double multiple[3] = {impulse.x / quantum, impulse.y / quantum, impulse.z / quantum};
  for (int axis = 0; axis < 3; ++axis)
    if (Kokkos::fabs(multiple[axis]) < 4e18)
      Kokkos::atomic_add(&sum[axis], static_cast<std::int64_t>(Kokkos::round(multiple[axis])));
}

/// Impulse, kg m/s, that a sum of multiples of `quantum`, kg m/s, holds; clears the sum.
KOKKOS_INLINE_FUNCTION Point take_impulse(std::int64_t (&sum)[3], double quantum) {
  const Point impulse{quantum * static_cast<double>(sum[0]), quantum * static_cast<double>(sum[1]),
                      quantum * static_cast<double>(sum[2])};
  for (std::int64_t& component : sum) component = 0;
  return impulse;
}

/// Increments of all impulses in a round. A fixed number of work items share the constraints.
template <class ExecutionSpace>
struct SolveImpulsesFunctor {
  ContactViews<ExecutionSpace> views;
  int items, round;

  KOKKOS_FUNCTION void operator()(const int item) const {
    const int room = static_cast<int>(views.constraint.extent(0)), found = views.progress(0).constraints;
    for (int k = item; k < (found < room ? found : room); k += items) {
      solve(views.constraint(k));
      add_to_sums(views.constraint(k));
    }
  }

  /// Adds the increments to the sums of vertices that do not list the constraint.
  KOKKOS_FUNCTION void add_to_sums(const ContactConstraint& constraint) const {
    for (int slot = 0; slot < 4; ++slot) {
      if (!DetectConstraintsFunctor<ExecutionSpace>::takes_part(constraint, slot)) continue;
      const int i = constraint.vertex[slot];
      if (views.is_listed(i)) continue;
      const double quantum = impulse_quantum(views, i);
      ImpulseSum& sum = views.impulse_sum(i);
      add_impulse(sum.total,
                  impulse_on(constraint, slot, constraint.normal_increment, constraint.friction_increment),
                  quantum);
      if (round + 1 == impulse_rounds && constraint.friction > 0.0)
        add_impulse(sum.friction, impulse_on(constraint, slot, 0.0, constraint.friction_impulse), quantum);
    }
  }

  KOKKOS_FUNCTION void solve(ContactConstraint& constraint) const {
    Point relative{0.0, 0.0, 0.0}, rotated{0.0, 0.0, 0.0};
    double along = 0.0, across = 0.0;  // inverse masses, 1/kg
    const bool edges = is_edge_edge(constraint);
    for (int slot = 0; slot < 4; ++slot) {
      if (!DetectConstraintsFunctor<ExecutionSpace>::takes_part(constraint, slot)) continue;
      const int i = constraint.vertex[slot];
      const Point v = load_points<double>(views.start_v, i), free = free_axes<double>(&views.fixed_dofs(i));
      const Point lever = lever_of(constraint, edges, slot), &n = constraint.normal;
      const double weight = constraint.weight[slot], split = views.constraints(i) * views.inverse_mass(i);
      const double any = free.x + free.y + free.z > 0.0 ? 1.0 : 0.0;
      relative = relative + weight * v;
      rotated = rotated + dot(n, v) * lever;
      along += split * weight * weight * (free.x * n.x * n.x + free.y * n.y * n.y + free.z * n.z * n.z);
      across += split * any * (weight * weight + dot(lever, lever));
    }
    if (!(along > 0.0)) return;  // no part can move
    const double speed = dot(relative, constraint.normal),
                 normal_impulse = constraint.normal_impulse + (constraint.target_velocity - speed) / along;
    const double clamped = normal_impulse > 0.0 ? normal_impulse : 0.0;
    constraint.normal_increment = clamped - constraint.normal_impulse;
    constraint.normal_impulse = clamped;
    if (constraint.friction > 0.0) {
      const Point sliding = relative - speed * constraint.normal + rotated;
      Point friction_impulse =
          constraint.friction_impulse -
          (1.0 / across) *
              (sliding - dot(sliding, constraint.normal) * constraint.normal - constraint.friction_target);
      const double size = length(friction_impulse), most = constraint.friction * clamped;
      if (size > most) friction_impulse = (most / size) * friction_impulse;
      constraint.friction_increment = friction_impulse - constraint.friction_impulse;
      constraint.friction_impulse = friction_impulse;
    }
  }
};

/// Adds the increments of a round to the velocity of every vertex, in the sorted order of its constraints
/// where they are listed.
/// The last round writes the velocities of the step and adds the work of the impulses: each impulse times the
/// mean of the velocities before and after, since impulses change only the kinetic energy. The impulses of an
/// interval change its displacements and the velocities at its end; their work counts the kinetic energy
/// alone.
template <class ExecutionSpace>
struct ApplyImpulsesFunctor {
  ContactViews<ExecutionSpace> views;
  UnmanagedTable<ExecutionSpace, double, 3> x, v;
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (views.constraints(i) == 0) return;
    const bool is_listed = views.is_listed(i);
    if (round == 0 && is_listed) sort_constraints(views, i);
    Point sum{0.0, 0.0, 0.0};
    if (!is_listed) sum = take_impulse(views.impulse_sum(i).total, impulse_quantum(views, i));
    for_each_listed(i, [&](const ContactConstraint& constraint, int slot) {
      sum = sum + impulse_on(constraint, slot, constraint.normal_increment, constraint.friction_increment);
    });
    const Point free = free_axes<double>(&views.fixed_dofs(i)), dv = views.inverse_mass(i) * sum;
    const Point corrected =
        load_points<double>(views.start_v, i) + Point{free.x * dv.x, free.y * dv.y, free.z * dv.z};
    store_points(views.start_v, i, corrected);
    if (round + 1 < impulse_rounds) return;
    const Point before = load_points<double>(v, i);
    Point after = corrected;
    if (views.by_interval) {
      const Point change = corrected - mean_velocity(views, x, i);
      after = before + change;
      store_points(x, i, load_points<double>(x, i) + views.progress(0).dt * change);
    }
    const Point mean = 0.5 * (after + before);
    Point friction_sum{0.0, 0.0, 0.0};  // friction impulse of all rounds, kg m/s
    if (!is_listed) friction_sum = take_impulse(views.impulse_sum(i).friction, impulse_quantum(views, i));
    for_each_listed(i, [&](const ContactConstraint& constraint, int slot) {
      if (constraint.friction > 0.0)
        friction_sum = friction_sum + impulse_on(constraint, slot, 0.0, constraint.friction_impulse);
    });
    const double friction =
        dot(Point{free.x * friction_sum.x, free.y * friction_sum.y, free.z * friction_sum.z}, mean);
    views.work(i).normal += 1.0 / views.inverse_mass(i) * dot(after - before, mean) - friction;
    views.work(i).friction += friction;
    store_points(v, i, after);
  }

  /// Calls `visit(constraint, slot)` for the listed constraints of vertex i in their order.
  template <class Visit>
  KOKKOS_FUNCTION void for_each_listed(int i, const Visit& visit) const {
    if (!views.is_listed(i)) return;
    for (int k = 0; k < views.constraints(i); ++k) {
      const int number = views.vertex_constraint(i, k);
      visit(views.constraint(number / 4), number % 4);
    }
  }
};

}  // namespace drogue::fabric
