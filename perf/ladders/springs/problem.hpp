#pragma once

#include "perf/ladders/ladder.hpp"
#include "perf/problems/sheet.hpp"

namespace drogue::perf::ladder {

/// Triangles that meet at a vertex of the meshes of this ladder, at most.
inline constexpr int most_triangles = 8;

/// Triangle of a vertex, seen from it: the other two vertices in the order of the triangle, and the squared
/// lengths at rest of the edges opposite the vertex, `a` and `b`, m^2.
struct VertexTriangle {
  int a, b;
  double rest[3];
};

/// A mesh with its vertices in one order. Rungs gather forces: each vertex has its triangles.
struct Numbering {
  fabric::Parameters parameters;
  std::vector<std::vector<VertexTriangle>> triangles;  ///< of each vertex
  sheet::State start, expected;  ///< before the steps and after, by kernels/reference/fabric

  [[nodiscard]] std::size_t vertices() const { return triangles.size(); }
};

/// Problem of the spring ladder: Runge-Kutta steps of a stretched sheet of biquadratic springs. Mesh
/// generators often number vertices without regard to neighbourhood, as here a random permutation does.
struct SpringProblem {
  /// Largest error of a rung: rounding of positions, over displacements of a thousandth of them.
  static constexpr double tolerance = 1e-10;

  Numbering scattered, renumbered;
  long steps;
  double dt;                 ///< s
  double two_lambda_mu, mu;  ///< 2 (lambda + mu) and mu of the membrane with twice the shear modulus, N/m
};

/// Order of the vertices of a mesh: entry k is the present index of the vertex that becomes vertex k.
using VertexOrder = std::vector<int> (*)(const mesh::Mesh&);

/// Mesh of about `vertices` vertices; `reorder` changes the order of the scattered ones. Throws
/// std::invalid_argument for too few vertices, and unless the order holds each vertex once.
[[nodiscard]] SpringProblem make_spring_problem(int vertices, long steps, VertexOrder reorder = nullptr);

/// Largest difference of a position from the expected one, over the largest displacement of the steps.
/// Infinite for values that are not finite. Does not throw.
[[nodiscard]] double difference(const Numbering& numbering, const std::vector<fabric::Vector>& x);

/// Work per step of four stages with `launches` kernels each: `stored` numbers and two indices per vertex and
/// triangle, loads of two neighbours, and `flops` per vertex and triangle. Does not throw.
[[nodiscard]] Work spring_work(const SpringProblem& problem, double launches, double stored, double flops);

}  // namespace drogue::perf::ladder
