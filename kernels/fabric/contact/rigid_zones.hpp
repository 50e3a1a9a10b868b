#pragma once

#include "kernels/fabric/contact/continuous_detection.hpp"

namespace drogue::fabric {

// Rigid impact zones (Provot 1997, Bridson, Fedkiw and Anderson 2002): vertices whose parts would cross move
// in the step as one rigid body with their momentum and angular momentum. Zones only grow.

/// Labels the zone of every vertex by its least vertex.
template <class ExecutionSpace>
struct LabelZonesFunctor {
  ContactViews<ExecutionSpace> views;
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (views.progress(0).crossing[round] == 0) return;
    const int zone = find_root(views.zone, i);
    views.label(i) = zone;
    if (zone != i) Kokkos::atomic_max(&views.zone_end(zone), i);
  }
};

/// Inertia tensor of point masses about the origin of their position vectors, kg m^2.
struct Inertia {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, yz = 0.0, zx = 0.0;

  KOKKOS_FUNCTION void add(double mass, const Point& r) {
    xx += mass * (r.y * r.y + r.z * r.z), yy += mass * (r.z * r.z + r.x * r.x);
    zz += mass * (r.x * r.x + r.y * r.y);
    xy -= mass * r.x * r.y, yz -= mass * r.y * r.z, zx -= mass * r.z * r.x;
  }

  /// Angular velocity for an angular momentum, 1/s. Masses on a line do not determine the component along it:
  /// a small multiple of the identity regularises the tensor, and iterative refinement removes its effect.
  [[nodiscard]] KOKKOS_FUNCTION Point angular_velocity(const Point& momentum) const {
    const double least = 1e-12 * (xx + yy + zz);
    const Point a{xx + least, xy, zx}, b{xy, yy + least, yz}, c{zx, yz, zz + least};
    const double determinant = dot(a, cross(b, c));
    Point angular_velocity{0.0, 0.0, 0.0};
    if (!(determinant > 0.0)) return angular_velocity;
    for (int refined = 0; refined < 3; ++refined) {
      const Point present{xx * angular_velocity.x + xy * angular_velocity.y + zx * angular_velocity.z,
                          xy * angular_velocity.x + yy * angular_velocity.y + yz * angular_velocity.z,
                          zx * angular_velocity.x + yz * angular_velocity.y + zz * angular_velocity.z};
      const Point residual = momentum - present;
      angular_velocity = angular_velocity +
                         (1.0 / determinant) *
                             (residual.x * cross(b, c) + residual.y * cross(c, a) + residual.z * cross(a, b));
    }
    return angular_velocity;
  }
};

/// r after the Cayley rotation (1 - [c])^-1 (1 + [c]), whose angle is 2 atan |c| about c.
KOKKOS_INLINE_FUNCTION Point rotated(const Point& c, const Point& r) {
  const Point across = cross(c, r);
  return r + (2.0 / (1.0 + dot(c, c))) * (across + cross(c, across));
}

/// Computes the motion of each zone. The work item of the least vertex of a zone adds its vertices in order.
template <class ExecutionSpace>
struct ZoneMotionFunctor {
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  ContactViews<ExecutionSpace> views;
  Points3 x, v;  ///< at the end of the step, before zones
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (views.progress(0).crossing[round] == 0 || views.label(i) != i) return;
    if (views.zone_end(i) == i && views.stuck(i) == 0) return;
    ZoneMotion motion{};
    if (!follow_fixed_vertices(i, motion)) fit_rigid_motion(i, motion);
    views.motion(i) = motion;
  }

  /// Calls `visit(j)` for the vertices of zone i.
  template <class Visit>
  KOKKOS_FUNCTION void each(int i, const Visit& visit) const {
    for (int j = i; j <= views.zone_end(i); ++j)
      if (views.label(j) == i) visit(j);
  }

  /// A zone with fixed or stuck vertices translates by the mean displacement of these. Returns false without.
  KOKKOS_FUNCTION bool follow_fixed_vertices(int i, ZoneMotion& motion) const {
    double fixed = 0.0;
    Point shift{0.0, 0.0, 0.0}, velocity{0.0, 0.0, 0.0};
    each(i, [&](int j) {
      const bool stuck = views.stuck(j) != 0;
      if (!stuck && !views.is_fixed(j)) return;
      fixed += 1.0;
      if (stuck) return;
      shift = shift + (load_points<double>(x, j) - load_points<double>(views.start_x, j));
      velocity = velocity + load_points<double>(v, j);
    });
    if (fixed == 0.0) return false;
    motion.fixed = 1;
    motion.to = (1.0 / fixed) * shift;
    motion.velocity = (1.0 / fixed) * velocity;
    return true;
  }

  /// A free zone is a rigid body: its centre moves as that of its vertices, its rotation is the least-squares
  /// fit of their displacements, and its angular velocity has their angular momentum at the end of the step.
  KOKKOS_FUNCTION void fit_rigid_motion(int i, ZoneMotion& motion) const {
    double mass = 0.0;
    Point from{0.0, 0.0, 0.0}, to = from, velocity = from;
    each(i, [&](int j) {
      const double m = 1.0 / views.inverse_mass(j);
      mass += m;
      from = from + m * load_points<double>(views.start_x, j);
      to = to + m * load_points<double>(x, j);
      velocity = velocity + m * load_points<double>(v, j);
    });
    motion.from = (1.0 / mass) * from, motion.to = (1.0 / mass) * to,
    motion.velocity = (1.0 / mass) * velocity;
    Inertia before;
    Point swept{0.0, 0.0, 0.0}, momentum{0.0, 0.0, 0.0};
    each(i, [&](int j) {
      const double m = 1.0 / views.inverse_mass(j);
      const Point r = load_points<double>(views.start_x, j) - motion.from,
                  arm = load_points<double>(x, j) - motion.to;
      before.add(m, r);
      swept = swept + m * cross(r, arm);
      momentum = momentum + m * cross(arm, load_points<double>(v, j) - motion.velocity);
    });
    motion.rotation = 0.5 * before.angular_velocity(swept);
    Inertia after;
    each(i, [&](int j) {
      after.add(1.0 / views.inverse_mass(j),
                rotated(motion.rotation, load_points<double>(views.start_x, j) - motion.from));
    });
    motion.angular_velocity = after.angular_velocity(momentum);
  }
};

/// Moves the vertices of zones rigidly from their positions at the beginning of the step and copies the
/// others.
template <class ExecutionSpace>
struct MoveZonesFunctor {
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  ContactViews<ExecutionSpace> views;
  Points3 x, v;
  int round;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (views.progress(0).crossing[round] == 0) return;
    Point position = load_points<double>(x, i), velocity = load_points<double>(v, i);
    if (views.in_zone(i)) {
      const ZoneMotion& motion = views.motion(views.label(i));
      const Point from = load_points<double>(views.start_x, i);
      if (motion.fixed == 0) {
        const Point arm = rotated(motion.rotation, from - motion.from);
        position = motion.to + arm;
        velocity = motion.velocity + cross(motion.angular_velocity, arm);
      } else if (!views.is_fixed(i)) {
        position = from + motion.to;
        velocity = motion.velocity;
      }
    }
    store_points(views.end_x, i, position);
    store_points(views.end_v, i, velocity);
  }
};

/// Writes the state of the zones and adds their work; stores the velocity change by forces alone. A zone
/// conserves its elastic energy, so its work is the gain of kinetic energy less the work of the forces along
/// the displacement. In an interval it is that of kinetic energy, and friction acts on displacements, which
/// need no allowance for forces.
template <class ExecutionSpace>
struct CommitZonesFunctor {
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  ContactViews<ExecutionSpace> views;
  Points3 x, v;

  KOKKOS_FUNCTION void operator()(const int i) const {
    ContactWork& work = views.work(i);
    if (views.by_interval) {
      if (views.progress(0).crossing[0] == 0 || !views.in_zone(i)) return;
      const Point before = load_points<double>(v, i), after = load_points<double>(views.end_v, i);
      work.normal += 0.5 * dot(after - before, after + before) / views.inverse_mass(i);
      store_points(x, i, load_points<double>(views.end_x, i));
      store_points(v, i, after);
      return;
    }
    const Point start = load_points<double>(views.start_v, i), kick = load_points<double>(v, i) - start;
    work.kick_x = kick.x, work.kick_y = kick.y, work.kick_z = kick.z;
    if (views.progress(0).crossing[0] == 0 || !views.in_zone(i)) return;
    const Point position = load_points<double>(views.end_x, i),
                velocity = load_points<double>(views.end_v, i);
    const Point force = (1.0 / views.progress(0).dt) * kick;  // per mass
    const Point moved = position - load_points<double>(views.start_x, i);
    work.normal +=
        (0.5 * dot(velocity - start, velocity + start) - dot(force, moved)) / views.inverse_mass(i);
    store_points(x, i, position);
    store_points(v, i, velocity);
  }
};

}  // namespace drogue::fabric
