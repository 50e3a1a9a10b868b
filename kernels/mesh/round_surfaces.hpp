#pragma once

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

// Surfaces with a given number of divisions, about the origin or the z axis. Lengths are in m. The normals of
// triangles, about which they turn counter-clockwise, point away from the axis or the centre.

/// Disk in the plane z = 0, m, with normals along +z: ring k of `rings` has 6 k vertices, those of the last
/// ring come last. No edge exceeds `disk_edge` radius / rings. Throws only std::bad_alloc.
[[nodiscard]] Mesh disk(double radius, int rings);

/// sqrt(1 + (pi / 3)^2).
inline constexpr double disk_edge = 1.447972;

/// Sphere, m: each triangle of an inscribed icosahedron in `divisions`^2 triangles, with their vertices moved
/// to the sphere. 10 divisions^2 + 2 vertices. No edge exceeds `sphere_edge` radius / divisions. Throws only
/// std::bad_alloc.
[[nodiscard]] Mesh sphere(double radius, int divisions);

/// Ratio of the edge of an icosahedron to the radius of its inscribed sphere.
inline constexpr double sphere_edge = 1.323170;

/// Half of a sphere, m, about the origin above the plane z = 0, open below: the rings of a disk at equal
/// angles. No edge exceeds `hemisphere_edge` radius / rings. Throws only std::bad_alloc.
[[nodiscard]] Mesh hemisphere(double radius, int rings);

/// pi / 2 sqrt(1 + (pi / 3)^2).
inline constexpr double hemisphere_edge = 2.274470;

/// Cylinder, m, about the z axis from z = -length / 2 to length / 2 without its ends: `rows` + 1 circles of
/// `columns` vertices. Throws only std::bad_alloc.
[[nodiscard]] Mesh tube(double radius, double length, int columns, int rows);

/// Tube, m, of 6 `rings` columns whose ends are closed by disks. Throws only std::bad_alloc.
[[nodiscard]] Mesh closed_cylinder(double radius, double length, int rings, int rows);

}  // namespace drogue::mesh
