#include "kernels/reference/fabric/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace drogue::reference {

namespace {

using LongVector = std::array<long double, 3>;

LongVector less(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {static_cast<long double>(a[0]) - b[0], static_cast<long double>(a[1]) - b[1],
          static_cast<long double>(a[2]) - b[2]};
}

long double inner(const LongVector& a, const LongVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Distance of the origin from a segment, m.
long double from_segment(const LongVector& a, const LongVector& b) {
  const LongVector direction = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const long double squared = inner(direction, direction);
  const long double u = squared > 0 ? std::clamp(-inner(a, direction) / squared, 0.0L, 1.0L) : 0.0L;
  return std::hypot(a[0] + u * direction[0], a[1] + u * direction[1], a[2] + u * direction[2]);
}

/// Returns whether the origin projects into a triangle, and its distance `height` from the plane, m.
bool above(const std::array<LongVector, 3>& t, long double& height) {
  const auto cross = [](const LongVector& a, const LongVector& b) {
    return LongVector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  // The projection is inside if the vector areas of the three triangles with the origin point to the side of
  // the normal.
  LongVector normal{};
  std::array<LongVector, 3> flank;
  for (std::size_t k = 0; k < 3; ++k) {
    flank[k] = cross(t[k], t[(k + 1) % 3]);
    for (std::size_t axis = 0; axis < 3; ++axis) normal[axis] += flank[k][axis];
  }
  const long double area = std::sqrt(inner(normal, normal));
  if (!(area > 0)) return false;
  height = std::abs(inner(normal, t[0])) / area;
  return std::ranges::all_of(flank, [&](const LongVector& f) { return inner(f, normal) >= 0; });
}

}  // namespace

double distance_from(const fabric::Body& body, const std::array<double, 3>& place) {
  const LongVector r = less(place, body.centre), n = {body.normal[0], body.normal[1], body.normal[2]};
  const long double height = inner(r, n), out = std::sqrt(inner(r, r));
  switch (body.kind) {
    case fabric::BodyKind::plane:
      return static_cast<double>(height);
    case fabric::BodyKind::sphere:
      return static_cast<double>(out - body.radius);
    case fabric::BodyKind::disk: {
      const long double beside = std::sqrt(std::max(0.0L, out * out - height * height));
      return static_cast<double>(std::hypot(height, std::max(0.0L, beside - body.radius)));
    }
    default:
      throw std::invalid_argument("reference body: a level set has no distance");
  }
}

namespace {

/// `enters` for a segment or a triangle.
template <std::size_t size>
bool part_enters(const fabric::Body& body, const std::array<std::array<double, 3>, size>& corners) {
  std::array<LongVector, size> t;
  for (std::size_t k = 0; k < size; ++k) t[k] = less(corners[k], body.centre);
  if (body.kind != fabric::BodyKind::disk) {
    if (std::ranges::any_of(corners, [&](const auto& x) { return distance_from(body, x) < 0.0; }))
      return true;
    if (body.kind != fabric::BodyKind::sphere) return false;
    for (std::size_t k = 0; k < size; ++k)
      if (from_segment(t[k], t[(k + 1) % size]) < body.radius) return true;
    long double height = 0;
    if constexpr (size == 3) return above(t, height) && height < body.radius;
    return false;
  }
  // The intersection with the plane of the disk is a point or a segment. It meets the disk if its point
  // closest to the centre does.
  const LongVector n = {body.normal[0], body.normal[1], body.normal[2]};
  std::vector<LongVector> passing;
  for (std::size_t k = 0; k < size; ++k) {
    const LongVector &a = t[k], &b = t[(k + 1) % size];
    const long double from = inner(a, n), to = inner(b, n);
    if (from == 0) passing.push_back(a);
    if (from * to >= 0) continue;
    const long double u = from / (from - to);
    passing.push_back({a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])});
  }
  for (const LongVector& a : passing)
    for (const LongVector& b : passing)
      if (from_segment(a, b) <= body.radius) return true;
  return false;
}

}  // namespace

bool enters(const fabric::Body& body, const std::array<std::array<double, 3>, 3>& triangle) {
  return part_enters(body, triangle);
}

bool enters(const fabric::Body& body, const std::array<std::array<double, 3>, 2>& segment) {
  return part_enters(body, segment);
}

}  // namespace drogue::reference
