#pragma once

#include "kernels/device/expression.hpp"
#include "kernels/fabric/body.hpp"
#include "kernels/spatial/closest_points.hpp"

namespace drogue::fabric {

using spatial::ClosestOfSegments;
using spatial::ClosestOnTriangle;
using spatial::Point;
using spatial::Vector3;

/// Body in kernels.
struct Obstacle {
  BodyKind kind;
  Point centre, normal;
  double radius, friction;
  device::ExpressionProgram level_set;
};

[[nodiscard]] inline Obstacle obstacle(const Body& body) {
  const auto point = [](const Vector& a) { return Point{a[0], a[1], a[2]}; };
  return {.kind = body.kind,
          .centre = point(body.centre),
          .normal = point(body.normal),
          .radius = body.radius,
          .friction = body.friction,
          .level_set = body.level_set};
}

/// Distance of a point from a body, m, negative inside, and the outward unit vector.
struct SignedDistance {
  double distance;
  Point outward;
};

/// Closest point of a disk to x, m.
KOKKOS_INLINE_FUNCTION Point nearest_on_disk(const Obstacle& disk, const Point& x) {
  const Point centre = disk.centre, normal = disk.normal, from = x - centre;
  const Point in_plane = from - dot(from, normal) * normal;
  const double out = length(in_plane);
  return centre + (out > disk.radius ? disk.radius / out : 1.0) * in_plane;
}

/// Signed distance of a disk, sphere or plane.
KOKKOS_INLINE_FUNCTION SignedDistance signed_distance(const Obstacle& body, const Point& x) {
  const Point normal = body.normal, from = x - body.centre;
  switch (body.kind) {
    case BodyKind::plane:
      return {dot(from, normal), normal};
    case BodyKind::sphere: {
      const double out = length(from);
      return {out - body.radius, out > 0.0 ? (1.0 / out) * from : normal};
    }
    default: {
      const Point r = x - nearest_on_disk(body, x);
      const double distance = length(r);
      return {distance, distance > 0.0 ? (1.0 / distance) * r : normal};
    }
  }
}

/// Signed distance of a level set: the value divided by the slope, by central differences over `width`, m,
/// which is the distance near a smooth surface. The expression is evaluated at one point of the code, since
/// compilers inline it at each call.
KOKKOS_INLINE_FUNCTION SignedDistance level_set_distance(const Obstacle& body, const Point& x, double width) {
  double value[7];
  for (int k = 0; k < 7; ++k) {
    const double shift = k == 0 ? 0.0 : k % 2 == 0 ? -width : width;
    value[k] =
        device::evaluate(body.level_set, k == 1 || k == 2 ? x.x + shift : x.x,
                         k == 3 || k == 4 ? x.y + shift : x.y, k == 5 || k == 6 ? x.z + shift : x.z, 0.0);
  }
  const Point slope = (0.5 / width) * Point{value[1] - value[2], value[3] - value[4], value[5] - value[6]};
  const double steep = length(slope);
  return steep > 0.0 ? SignedDistance{value[0] / steep, (1.0 / steep) * slope}
                     : SignedDistance{value[0], body.normal};
}

/// Fraction of a segment at which it is nearest to a sphere or disk. The distance from a convex set is convex
/// along a line: its slope has one change of sign. Above the face of a disk, on one side, an end is nearest.
KOKKOS_INLINE_FUNCTION double nearest_to_body(const Obstacle& body, const Point& a, const Point& b) {
  if (body.kind == BodyKind::sphere) return closest_on_segment(body.centre, a, b);
  const Point along = b - a, centre = body.centre, normal = body.normal;
  const double height_a = dot(a - centre, normal), height_b = dot(b - centre, normal);
  const Point flat_a = a - centre - height_a * normal, flat_b = b - centre - height_b * normal;
  const double squared = body.radius * body.radius;
  if (height_a * height_b > 0.0 && dot(flat_a, flat_a) <= squared && dot(flat_b, flat_b) <= squared)
    return height_a * height_a <= height_b * height_b ? 0.0 : 1.0;
  double low = 0.0, high = 1.0;
  for (int halving = 0; halving < 24; ++halving) {
    const double middle = 0.5 * (low + high);
    const Point x = a + middle * along, r = x - nearest_on_disk(body, x);
    (dot(r, along) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Distance of an edge from a sphere or disk, m.
KOKKOS_INLINE_FUNCTION double edge_distance(const Obstacle& body, const Point& a, const Point& b) {
  const double u = nearest_to_body(body, a, b);
  return signed_distance(body, a + u * (b - a)).distance;
}

/// Point of a body that the inside of a face may touch, for `side` 0 and 1: the centre of a sphere; the
/// points of the rim of a disk that are farthest along the normal of the face. False if there is none.
KOKKOS_INLINE_FUNCTION bool facing_point(const Obstacle& body, const Point& face_normal, int side,
                                         Point& point) {
  const Point centre = body.centre, normal = body.normal;
  point = centre;
  if (body.kind == BodyKind::sphere) return side == 0;
  const Point in_plane = face_normal - dot(face_normal, normal) * normal;
  const double out = length(in_plane);
  if (!(out > 1e-12 * length(face_normal))) return false;  // edges detect the contact
  point = centre + ((side == 0 ? body.radius : -body.radius) / out) * in_plane;
  return true;
}

/// True for bodies that edges and faces may touch between their vertices.
KOKKOS_INLINE_FUNCTION bool between_vertices(const Obstacle& body) {
  return body.kind == BodyKind::sphere || body.kind == BodyKind::disk;
}

}  // namespace drogue::fabric
