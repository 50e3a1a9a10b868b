#pragma once

#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Vertices come in slices, and of a slice all the first neighbours lie side by side, then all the second
/// ones (sliced ELLPACK, Monakov et al. 2010): threads of a warp, or lanes of a register, read consecutive
/// numbers.
inline constexpr int slice = 32;

/// What each vertex is part of, as its kernel gathers it. Slot k of vertex i lies at
/// (first[i / slice] + k) * slice + i % slice. A vertex with fewer slots than its slice has neutral ones: its
/// own number and no stiffness.
template <int neighbours, int values>
struct Slots {
  std::vector<int> first;  ///< of every slice, and the end
  std::array<std::vector<int>, neighbours> neighbour;
  std::array<std::vector<double>, values> value;
};

/// Triangles of every vertex: the other two vertices in the triangle's order; L^2 of the edges opposite the
/// vertex itself and opposite those two, m^2, and the inverse area, 1/m^2.
using TriangleSlots = Slots<2, 4>;

/// Springs of every vertex: the other end; stiffness, N/m, and length at rest, m.
using SpringSlots = Slots<1, 2>;

/// Neighbours of every vertex: the other end of an edge or line, and the dashpot between, kg/s.
using DashpotSlots = Slots<1, 1>;

/// Empty for the models that are made of springs.
[[nodiscard]] TriangleSlots triangle_slots(const Mesh& mesh, const Material& material);

/// Lines, and in models made of springs the edges of triangles, an edge of two triangles once. A spring of a
/// vector is one of length zero that a dead force stretches: `rest_pull`.
[[nodiscard]] SpringSlots spring_slots(const Mesh& mesh, const Material& material);

/// The triangles of every vertex whatever the model.
[[nodiscard]] TriangleSlots surface_slots(const Mesh& mesh);

/// Edges of triangles and lines, each pair of vertices once: rate times the reduced mass of its two ends.
[[nodiscard]] DashpotSlots dashpot_slots(const Mesh& mesh, const std::vector<double>& mass, double rate);

/// Bending of every vertex: another one, and the weight of the way to it in the force, N/m, of either sign.
using BendingSlots = Slots<1, 1>;

/// Isometric bending across edges of two triangles (Bergou et al. 2006): with the cotangents K of a hinge's
/// four vertices, which sum to zero, its energy is stiffness / (A_0 + A_1) * (sum K x)^2 / 2, whose force is
/// linear and has no torque. Without their factor of 3 a cylinder of curvature c has stiffness c^2 / 2 per
/// area, as on the equilateral mesh of Seung and Nelson 1988. Hinges that are not flat at rest throw
/// std::invalid_argument.
[[nodiscard]] BendingSlots bending_slots(const Mesh& mesh, double stiffness);

/// -sum k (X_j - X_i) of the springs of every vertex, N; empty but for Model::linear_vector.
[[nodiscard]] std::vector<Vector> rest_pull(const Mesh& mesh, const Material& material);

}  // namespace drogue::fabric
