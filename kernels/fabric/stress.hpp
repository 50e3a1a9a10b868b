#pragma once

#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/state.hpp"

namespace drogue::fabric {

/// A symmetric tensor in a plane.
struct Plane {
  double xx, yy, xy;
};

/// A triangle in a frame of its plane: vertex 0 lies at the origin, vertex 1 at (x1, 0), vertex 2 at (x2,
/// y2).
struct Flat {
  double x1, x2, y2;
};

/// From squared lengths of the edges opposite its vertices, m^2, and its inverse area, 1/m^2.
KOKKOS_INLINE_FUNCTION Flat flat(const Edges<double>& squared, double inverse_area) {
  const double x1 = device::square_root(squared.of[2]);
  return {x1, (squared.of[2] + squared.of[1] - squared.of[0]) / (2.0 * x1), 2.0 / (inverse_area * x1)};
}

/// Sum of tension times edge times edge over the area, N/m: of edges now the Cauchy stress, of edges at rest
/// the second one of Piola and Kirchhoff. In place of eq. 2.14-2.16. Nothing where there is no area.
KOKKOS_INLINE_FUNCTION Plane edge_stress(const Edges<double>& tension, const Flat& f) {
  const double twice = f.x1 * f.y2, per_area = twice > 0.0 ? 2.0 / twice : 0.0, across = f.x2 - f.x1;
  const double t0 = per_area * tension.of[0], t1 = per_area * tension.of[1], t2 = per_area * tension.of[2];
  return {t2 * f.x1 * f.x1 + t1 * f.x2 * f.x2 + t0 * across * across, (t1 + t0) * f.y2 * f.y2,
          (t1 * f.x2 + t0 * across) * f.y2};
}

/// The symmetric part of R^T P (Biot 1965), force per length at rest, turned into the plane of now:
/// P = F S is the first stress of Piola and Kirchhoff, R the rotation of F. U = (C + J) / sqrt(tr C + 2 J).
KOKKOS_INLINE_FUNCTION Plane nominal_stress(const Plane& s, const Flat& rest, const Flat& now) {
  const double f11 = now.x1 / rest.x1, f22 = now.y2 / rest.y2, f12 = (now.x2 - f11 * rest.x2) / rest.y2;
  const double j = f11 * f22, sum = f11 + f22;
  const double size = device::square_root(sum * sum + f12 * f12), scale = size > 0.0 ? 1.0 / size : 0.0;
  const double u11 = scale * (f11 * f11 + j), u22 = scale * (f12 * f12 + f22 * f22 + j),
               u12 = scale * f11 * f12;
  const Plane biot{u11 * s.xx + u12 * s.xy, u12 * s.xy + u22 * s.yy,
                   0.5 * (u11 * s.xy + u12 * s.yy + u12 * s.xx + u22 * s.xy)};
  // Columns of R are (cosine, sine) and (-sine, cosine).
  const double cosine = scale * sum, sine = -scale * f12;
  const double cc = cosine * cosine, ss = sine * sine, cs = cosine * sine;
  return {cc * biot.xx + ss * biot.yy - 2.0 * cs * biot.xy, ss * biot.xx + cc * biot.yy + 2.0 * cs * biot.xy,
          cs * (biot.xx - biot.yy) + (cc - ss) * biot.xy};
}

/// Principal values and the direction (cosine, sine) of the major one; the first axis where all are alike.
struct Principal {
  double major, minor, cosine, sine;
};

KOKKOS_INLINE_FUNCTION Principal principal(const Plane& s) {
  const double half = 0.5 * (s.xx - s.yy), mean = 0.5 * (s.xx + s.yy);
  const double radius = device::square_root(half * half + s.xy * s.xy);
  // Of the two rows that give the direction the one without cancellation.
  const double x = half >= 0.0 ? radius + half : s.xy, y = half >= 0.0 ? s.xy : radius - half;
  const double size = device::square_root(x * x + y * y);
  const bool alike = !(size > 0.0);
  return {mean + radius, mean - radius, alike ? 1.0 : x / size, alike ? 0.0 : y / size};
}

/// Of length one; a vector of no length stays.
KOKKOS_INLINE_FUNCTION Vector3<double> unit(const Vector3<double>& a) {
  const double size = device::square_root(dot(a, a));
  return (size > 0.0 ? 1.0 / size : 0.0) * a;
}

}  // namespace drogue::fabric
