#pragma once

#include "kernels/fabric/elastic/sliced_ell.hpp"
#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Triangles of every vertex as rings of neighbours: each neighbour and the previous one form a triangle with
/// the vertex, in the order of the triangle. Values: squared length of the edge to the neighbour, m^2, its
/// product with the edge to the previous neighbour, m^2, and the inverse area, 1/m^2. The vertex itself
/// separates two rings, or parts of an open one: triangles with a repeated corner have no area, as those of
/// neutral slots.
using RingAdjacency = SlicedEll<3>;

/// Springs of every vertex: neighbour; stiffness, N/m, and length at rest, m.
using SpringAdjacency = SlicedEll<2>;

/// Dashpots of every vertex: neighbour along an edge or line; damping coefficient, kg/s.
using DashpotAdjacency = SlicedEll<1>;

/// Ring adjacency of the triangles of a mesh. Throws only std::bad_alloc.
[[nodiscard]] RingAdjacency ring_adjacency(const Mesh& mesh);

/// Springs along lines and, in models without whole triangles, along the edges of triangles, each edge once.
/// A spring of Model::linear_vector has length zero and a dead force, `rest_forces`. Throws only
/// std::bad_alloc.
[[nodiscard]] SpringAdjacency spring_adjacency(const Mesh& mesh, const Material& material);

/// Dashpots along edges of triangles and lines, each pair of vertices once, with coefficients of `rate`, 1/s,
/// times the reduced mass of the two ends, kg. Throws only std::bad_alloc.
[[nodiscard]] DashpotAdjacency dashpot_adjacency(const Mesh& mesh, const std::vector<double>& mass,
                                                 double rate);

/// Bending of every vertex: neighbour; weight of the vector to it in the force, N/m, of either sign.
using BendingAdjacency = SlicedEll<1>;

/// Isometric bending across edges of two triangles (Bergou et al. 2006): with the cotangents K of a hinge's
/// four vertices, which sum to zero, its energy is stiffness / (A_0 + A_1) * (sum K x)^2 / 2, J. The force is
/// linear and has no torque. Without their factor of 3 a cylinder of curvature c has the energy
/// stiffness c^2 / 2 per area, as on the equilateral mesh of Seung and Nelson 1988. Throws
/// std::invalid_argument for hinges that are not flat at rest.
[[nodiscard]] BendingAdjacency bending_adjacency(const Mesh& mesh, double stiffness);

/// Dead force -sum k (X_j - X_i) of the springs of every vertex, N, for Model::linear_vector; empty for other
/// models. Throws only std::bad_alloc.
[[nodiscard]] std::vector<Vector> rest_forces(const Mesh& mesh, const Material& material);

}  // namespace drogue::fabric
