#pragma once

// Definitions of SolverOn: stress.

#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

/// Stress of all triangles, and where there is room for them the tensors.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::find_stress(StressMeasure measure, const StressView<ExecutionSpace>& to,
                                                const TensorView<ExecutionSpace>& tensor) {
  if (_material.model == Model::linear_vector)
    throw std::invalid_argument("fabric solver: springs of vectors (Model I) have no stress");
  settle();
  const ExecutionSpace& space = _instance.space();
  if (!_triangles) _triangles.emplace(space, triangle_list(_mesh, _material));
  Kokkos::parallel_for(
      "drogue::fabric::stress",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(_mesh.triangles.size())),
      StressFunctor<ExecutionSpace, law>{*_triangles, _x, _cloth.moduli, measure, to, tensor});
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::stress(StressMeasure measure, std::span<Stress> of_triangles) {
  if (of_triangles.size() != _mesh.triangles.size())
    throw std::invalid_argument("fabric solver: there must be one stress a triangle");
  const StressView<ExecutionSpace> found("drogue::fabric::stress", of_triangles.size());
  find_stress(measure, found, {});
  stress_to_host(found, of_triangles);
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) {
  require_one_a_vertex(of_vertices.size());
  const StressView<ExecutionSpace> of_triangles("drogue::fabric::stress", _mesh.triangles.size()),
      found("drogue::fabric::vertex_stress", of_vertices.size());
  const TensorView<ExecutionSpace> tensor("drogue::fabric::stress_tensors", _mesh.triangles.size());
  find_stress(measure, of_triangles, tensor);
  Kokkos::parallel_for("drogue::fabric::vertex_stress",
                       Kokkos::RangePolicy<ExecutionSpace>(_instance.space(), 0, _vertices),
                       VertexStressFunctor<ExecutionSpace>{*_triangles, tensor, found});
  stress_to_host(found, of_vertices);
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::stress_to_host(const StressView<ExecutionSpace>& from,
                                                   std::span<Stress> to) const {
  const auto mirror = Kokkos::create_mirror_view(from);
  device::copy(_instance.space(), mirror, from);
  _instance.space().fence("drogue::fabric::stress_to_host");
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = {mirror(i, 0),
             mirror(i, 1),
             {mirror(i, 2), mirror(i, 3), mirror(i, 4)},
             {mirror(i, 5), mirror(i, 6), mirror(i, 7)}};
}

}  // namespace drogue::fabric
