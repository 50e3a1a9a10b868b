#pragma once

#include <numeric>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::perf::ladder {

/// Exercise `order`, from rung 3 to rung 4 of the spring ladder: entry k is the present index of the vertex
/// that becomes vertex k. The vertices of `mesh` are numbered at random; leave neighbours beside one another.
/// The positions `mesh.rest` and the triangles `mesh.triangles` are known.
struct OrderExercise {
  static std::vector<int> order(const mesh::Mesh& mesh) {
    std::vector<int> order(mesh.rest.size());
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
};

}  // namespace drogue::perf::ladder
