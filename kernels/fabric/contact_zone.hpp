#pragma once

#include "kernels/fabric/contact_check.hpp"

namespace drogue::fabric {

// Rigid impact zones (Provot 1997, Bridson, Fedkiw and Anderson 2002): vertices whose parts would cross go
// through the step as one rigid body with their momentum and angular momentum. Zones only grow.

/// Names every vertex's zone by its least vertex.
template <class ExecutionSpace>
struct LabelFunctor {
  ContactTable<ExecutionSpace> table;
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (table.progress(0).crossing[round] == 0) return;
    const int zone = zone_of(table.zone, i);
    table.label(i) = zone;
    if (zone != i) Kokkos::atomic_max(&table.zone_end(zone), i);
  }
};

/// Sums over some masses: moments of second degree about the origin they are taken from.
struct Inertia {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, yz = 0.0, zx = 0.0;

  KOKKOS_FUNCTION void add(double mass, const Point& r) {
    xx += mass * (r.y * r.y + r.z * r.z), yy += mass * (r.z * r.z + r.x * r.x);
    zz += mass * (r.x * r.x + r.y * r.y);
    xy -= mass * r.x * r.y, yz -= mass * r.y * r.z, zx -= mass * r.z * r.x;
  }

  /// The spin that gives an angular momentum, 1/s. Masses on a line do not tell their spin about it: a little
  /// is added to the moments, and what that costs is won back.
  [[nodiscard]] KOKKOS_FUNCTION Point spin(const Point& momentum) const {
    const double least = 1e-12 * (xx + yy + zz);
    const Point a{xx + least, xy, zx}, b{xy, yy + least, yz}, c{zx, yz, zz + least};
    const double determinant = dot(a, cross(b, c));
    Point spin{0.0, 0.0, 0.0};
    if (!(determinant > 0.0)) return spin;
    for (int refined = 0; refined < 3; ++refined) {
      const Point has{xx * spin.x + xy * spin.y + zx * spin.z, xy * spin.x + yy * spin.y + yz * spin.z,
                      zx * spin.x + yz * spin.y + zz * spin.z};
      const Point lacks = momentum - has;
      spin = spin +
             (1.0 / determinant) * (lacks.x * cross(b, c) + lacks.y * cross(c, a) + lacks.z * cross(a, b));
    }
    return spin;
  }
};

/// r turned by Cayley's rotation (1 - [c])^-1 (1 + [c]), by the angle 2 atan |c| about c.
KOKKOS_INLINE_FUNCTION Point turned(const Point& c, const Point& r) {
  const Point across = cross(c, r);
  return r + (2.0 / (1.0 + dot(c, c))) * (across + cross(c, across));
}

/// Finds how each zone moves: called for every vertex, it works for the least of each zone, which adds its
/// vertices in their order.
template <class ExecutionSpace>
struct ZoneFunctor {
  using Places = LentTable<ExecutionSpace, double, 3>;

  ContactTable<ExecutionSpace> table;
  Places x, v;  ///< at the end of the step, before zones
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (table.progress(0).crossing[round] == 0 || table.label(i) != i) return;
    if (table.zone_end(i) == i && table.stuck(i) == 0) return;
    ZoneMotion motion{};
    if (!hold(i, motion)) release(i, motion);
    table.motion(i) = motion;
  }

  /// Calls `take(j)` for the vertices of zone i.
  template <class Take>
  KOKKOS_FUNCTION void each(int i, const Take& take) const {
    for (int j = i; j <= table.zone_end(i); ++j)
      if (table.label(j) == i) take(j);
  }

  /// A zone with vertices that are held, or stuck, goes where they go on the mean.
  KOKKOS_FUNCTION bool hold(int i, ZoneMotion& motion) const {
    double fixed_dofs = 0.0;
    Point shift{0.0, 0.0, 0.0}, velocity{0.0, 0.0, 0.0};
    each(i, [&](int j) {
      const bool stuck = table.stuck(j) != 0;
      if (!stuck && !table.is_held(j)) return;
      fixed_dofs += 1.0;
      if (stuck) return;
      shift = shift + (load_points<double>(x, j) - load_points<double>(table.start_x, j));
      velocity = velocity + load_points<double>(v, j);
    });
    if (fixed_dofs == 0.0) return false;
    motion.fixed_dofs = 1;
    motion.to = (1.0 / fixed_dofs) * shift;
    motion.velocity = (1.0 / fixed_dofs) * velocity;
    return true;
  }

  /// A free one is a rigid body: its centre moves as that of its vertices, its rotation is that of the
  /// least squares of their ways, and its spin has their angular momentum where it ends.
  KOKKOS_FUNCTION void release(int i, ZoneMotion& motion) const {
    double mass = 0.0;
    Point from{0.0, 0.0, 0.0}, to = from, velocity = from;
    each(i, [&](int j) {
      const double m = 1.0 / table.inverse_mass(j);
      mass += m;
      from = from + m * load_points<double>(table.start_x, j);
      to = to + m * load_points<double>(x, j);
      velocity = velocity + m * load_points<double>(v, j);
    });
    motion.from = (1.0 / mass) * from, motion.to = (1.0 / mass) * to,
    motion.velocity = (1.0 / mass) * velocity;
    Inertia before;
    Point swept{0.0, 0.0, 0.0}, momentum{0.0, 0.0, 0.0};
    each(i, [&](int j) {
      const double m = 1.0 / table.inverse_mass(j);
      const Point r = load_points<double>(table.start_x, j) - motion.from,
                  arm = load_points<double>(x, j) - motion.to;
      before.add(m, r);
      swept = swept + m * cross(r, arm);
      momentum = momentum + m * cross(arm, load_points<double>(v, j) - motion.velocity);
    });
    motion.turn = 0.5 * before.spin(swept);
    Inertia after;
    each(i, [&](int j) {
      after.add(1.0 / table.inverse_mass(j),
                turned(motion.turn, load_points<double>(table.start_x, j) - motion.from));
    });
    motion.spin = after.spin(momentum);
  }
};

/// Moves the vertices of zones with them, from where the step began; the others end as they did.
template <class ExecutionSpace>
struct FollowFunctor {
  using Places = LentTable<ExecutionSpace, double, 3>;

  ContactTable<ExecutionSpace> table;
  Places x, v;
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (table.progress(0).crossing[round] == 0) return;
    Point place = load_points<double>(x, i), velocity = load_points<double>(v, i);
    if (table.in_zone(i)) {
      const ZoneMotion& motion = table.motion(table.label(i));
      const Point from = load_points<double>(table.start_x, i);
      if (motion.fixed_dofs == 0) {
        const Point arm = turned(motion.turn, from - motion.from);
        place = motion.to + arm;
        velocity = motion.velocity + cross(motion.spin, arm);
      } else if (!table.is_held(i)) {
        place = from + motion.to;
        velocity = motion.velocity;
      }
    }
    store_points(table.end_x, i, place);
    store_points(table.end_v, i, velocity);
  }
};

/// Puts the state where zones have brought it, and counts what that did; notes what forces alone gave. A zone
/// keeps its elastic energy, so what its vertices gained in the step counts, less the work of the forces on
/// where they went; velocities tell their mean.
template <class ExecutionSpace>
struct SettleFunctor {
  using Places = LentTable<ExecutionSpace, double, 3>;

  ContactTable<ExecutionSpace> table;
  Places x, v;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Point start = load_points<double>(table.start_v, i), kick = load_points<double>(v, i) - start;
    ContactWork& work = table.work(i);
    work.kick_x = kick.x, work.kick_y = kick.y, work.kick_z = kick.z;
    if (table.progress(0).crossing[0] == 0 || !table.in_zone(i)) return;
    const Point place = load_points<double>(table.end_x, i), velocity = load_points<double>(table.end_v, i);
    const Point force = (1.0 / table.dt) * kick;  // over the mass
    const Point moved = place - load_points<double>(table.start_x, i);
    work.normal +=
        (0.5 * dot(velocity - start, velocity + start) - dot(force, moved)) / table.inverse_mass(i);
    store_points(x, i, place);
    store_points(v, i, velocity);
  }
};

}  // namespace drogue::fabric
