#pragma once

#include "kernels/fabric/elastic/sliced_ell.hpp"
#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Triangles of every vertex as rings of neighbours: each neighbour and the one in the slot before it make a
/// triangle with the vertex, in the triangle's order. L^2 of the edge to the neighbour and its product with
/// the edge to the one before, m^2, and the inverse area, 1/m^2. Between two rings, or parts of a torn one,
/// stands the vertex itself: triangles with a corner twice have no area, and neutral slots make no other.
using RingAdjacency = SlicedEll<3>;

/// Springs of every vertex: the other end; stiffness, N/m, and length at rest, m.
using SpringAdjacency = SlicedEll<2>;

/// Neighbours of every vertex: the other end of an edge or line, and the dashpot between, kg/s.
using DashpotAdjacency = SlicedEll<1>;

/// Whatever the model.
[[nodiscard]] RingAdjacency ring_adjacency(const Mesh& mesh);

/// Lines, and in models made of springs the edges of triangles, an edge of two triangles once. A spring of a
/// vector is one of length zero that a dead force stretches: `rest_pull`.
[[nodiscard]] SpringAdjacency spring_adjacency(const Mesh& mesh, const Material& material);

/// Edges of triangles and lines, each pair of vertices once: rate times the reduced mass of its two ends.
[[nodiscard]] DashpotAdjacency dashpot_adjacency(const Mesh& mesh, const std::vector<double>& mass,
                                                 double rate);

/// Bending of every vertex: another one, and the weight of the way to it in the force, N/m, of either sign.
using BendingAdjacency = SlicedEll<1>;

/// Isometric bending across edges of two triangles (Bergou et al. 2006): with the cotangents K of a hinge's
/// four vertices, which sum to zero, its energy is stiffness / (A_0 + A_1) * (sum K x)^2 / 2, whose force is
/// linear and has no torque. Without their factor of 3 a cylinder of curvature c has stiffness c^2 / 2 per
/// area, as on the equilateral mesh of Seung and Nelson 1988. Hinges that are not flat at rest throw
/// std::invalid_argument.
[[nodiscard]] BendingAdjacency bending_adjacency(const Mesh& mesh, double stiffness);

/// -sum k (X_j - X_i) of the springs of every vertex, N; empty but for Model::linear_vector.
[[nodiscard]] std::vector<Vector> rest_pull(const Mesh& mesh, const Material& material);

}  // namespace drogue::fabric
