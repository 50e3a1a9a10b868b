#pragma once

#include "kernels/fabric/contact_touch.hpp"

namespace drogue::fabric {

// Impulses at the beginning of a step: projected Jacobi rounds, in which a vertex of n touches lends each of
// them a share 1/n of its mass (mass splitting, Tonge, Benevolenski and Voroshilov 2012). Impulses act
// between the vertices of a touch by their shares, so momentum is kept. What they add to the energy is at
// most what parts nearer than the thickness are given to part, each push times `wanted`, which has a bound
// that does not depend on the step (`wanted_velocity`), and what friction gives back of a kick (`hold`).

/// The impulse of a touch on the vertex in a slot of it, kg m/s.
KOKKOS_INLINE_FUNCTION Point impulse_on(const Touch& touch, int slot, double push, const Point& grip) {
  const Point lever = lever_of(touch, of_edges(touch), slot);
  return touch.share[slot] * (push * touch.normal + grip) + dot(lever, grip) * touch.normal;
}

/// What each touch gives more in this round. Called for a fixed number of items that share the touches.
template <class ExecutionSpace>
struct PushFunctor {
  ContactTable<ExecutionSpace> table;
  int items;

  KOKKOS_FUNCTION void operator()(const int item) const {
    const int room = static_cast<int>(table.touch.extent(0)), found = table.progress(0).touches;
    for (int k = item; k < (found < room ? found : room); k += items) press(table.touch(k));
  }

  KOKKOS_FUNCTION void press(Touch& touch) const {
    Point relative{0.0, 0.0, 0.0}, turned{0.0, 0.0, 0.0};
    double along = 0.0, across = 0.0;  // inverse masses, 1/kg
    const bool edges = of_edges(touch);
    for (int slot = 0; slot < 4; ++slot) {
      if (!TouchFunctor<ExecutionSpace>::takes_part(touch, slot)) continue;
      const int i = touch.vertex[slot];
      const Point v = load_points<double>(table.start_v, i), free = free_axes<double>(&table.fixed_dofs(i));
      const Point lever = lever_of(touch, edges, slot), &n = touch.normal;
      const double share = touch.share[slot], split = table.touches(i) * table.inverse_mass(i);
      const double any = free.x + free.y + free.z > 0.0 ? 1.0 : 0.0;
      relative = relative + share * v;
      turned = turned + dot(n, v) * lever;
      along += split * share * share * (free.x * n.x * n.x + free.y * n.y * n.y + free.z * n.z * n.z);
      across += split * any * (share * share + dot(lever, lever));
    }
    if (!(along > 0.0)) return;  // nothing of it can move
    const double speed = dot(relative, touch.normal), push = touch.push + (touch.wanted - speed) / along;
    const double pressed = push > 0.0 ? push : 0.0;
    touch.more_push = pressed - touch.push;
    touch.push = pressed;
    if (touch.friction > 0.0) {
      const Point sliding = relative - speed * touch.normal + turned;
      Point grip =
          touch.grip - (1.0 / across) * (sliding - dot(sliding, touch.normal) * touch.normal - touch.hold);
      const double size = length(grip), most = touch.friction * pressed;
      if (size > most) grip = (most / size) * grip;
      touch.more_grip = grip - touch.grip;
      touch.grip = grip;
    }
  }
};

/// Gives every vertex what its touches have for it in this round, in their order, which the first round
/// finds. After the last one the step gets the velocities, and what impulses did is counted: a kick changes
/// the kinetic energy alone, each part of it by its impulse times the mean of the velocities before and
/// after.
template <class ExecutionSpace>
struct GatherFunctor {
  ContactTable<ExecutionSpace> table;
  LentTable<ExecutionSpace, double, 3> v;
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (table.touches(i) == 0) return;
    if (round == 0) order_touches(table, i);
    const int count = table.touches(i);
    Point sum{0.0, 0.0, 0.0};
    for (int k = 0; k < count; ++k) {
      const int number = table.mine(i, k);
      const Touch& touch = table.touch(number / 4);
      sum = sum + impulse_on(touch, number % 4, touch.more_push, touch.more_grip);
    }
    const Point free = free_axes<double>(&table.fixed_dofs(i)), dv = table.inverse_mass(i) * sum;
    const Point after =
        load_points<double>(table.start_v, i) + Point{free.x * dv.x, free.y * dv.y, free.z * dv.z};
    store_points(table.start_v, i, after);
    if (round + 1 < impulse_rounds) return;
    const Point before = load_points<double>(v, i), mean = 0.5 * (after + before);
    Point fixed_dofs{0.0, 0.0, 0.0};  // what friction gave in all rounds, kg m/s
    for (int k = 0; k < count; ++k) {
      const int number = table.mine(i, k);
      const Touch& touch = table.touch(number / 4);
      if (touch.friction > 0.0) fixed_dofs = fixed_dofs + impulse_on(touch, number % 4, 0.0, touch.grip);
    }
    const double friction =
        dot(Point{free.x * fixed_dofs.x, free.y * fixed_dofs.y, free.z * fixed_dofs.z}, mean);
    table.work(i).normal += 1.0 / table.inverse_mass(i) * dot(after - before, mean) - friction;
    table.work(i).friction += friction;
    store_points(v, i, after);
  }
};

}  // namespace drogue::fabric
