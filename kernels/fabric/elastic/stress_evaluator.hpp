#pragma once

#include <optional>
#include <span>
#include <stdexcept>

#include "kernels/device/copy.hpp"
#include "kernels/fabric/elastic/dispatch_model.hpp"
#include "kernels/fabric/elastic/stress.hpp"
#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Stress of triangles and vertices on the host. The tables of triangles are made at the first request.
template <class ExecutionSpace>
class StressEvaluator {
 public:
  /// Stress of every triangle at the positions `x`, N/m. Blocks. Throws std::invalid_argument for a span of
  /// the wrong length and for Model::linear_vector.
  void triangles(const ExecutionSpace& space, const Parameters& p, const Moduli& moduli,
                 const PointsView<ExecutionSpace>& x, StressMeasure measure, std::span<Stress> of_triangles) {
    if (of_triangles.size() != p.mesh.triangles.size())
      throw std::invalid_argument("fabric solver: there must be one stress per triangle");
    const StressView<ExecutionSpace> stress("drogue::fabric::stress", of_triangles.size());
    evaluate(space, p, moduli, x, measure, stress, {});
    read(space, stress, of_triangles);
  }

  /// Stress of every vertex, N/m. Blocks. Throws std::invalid_argument for Model::linear_vector.
  void vertices(const ExecutionSpace& space, const Parameters& p, const Moduli& moduli,
                const PointsView<ExecutionSpace>& x, StressMeasure measure, std::span<Stress> of_vertices) {
    const StressView<ExecutionSpace> of_triangles("drogue::fabric::stress", p.mesh.triangles.size()),
        stress("drogue::fabric::vertex_stress", of_vertices.size());
    const TensorView<ExecutionSpace> tensor("drogue::fabric::stress_tensors", p.mesh.triangles.size());
    evaluate(space, p, moduli, x, measure, of_triangles, tensor);
    Kokkos::parallel_for("drogue::fabric::vertex_stress",
                         Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(of_vertices.size())),
                         VertexStressFunctor<ExecutionSpace>{*_triangles, tensor, stress});
    read(space, stress, of_vertices);
  }

 private:
  /// Enqueues the stress of all triangles, and of their tensors if `tensor` is not empty.
  void evaluate(const ExecutionSpace& space, const Parameters& p, const Moduli& moduli,
                const PointsView<ExecutionSpace>& x, StressMeasure measure,
                const StressView<ExecutionSpace>& to, const TensorView<ExecutionSpace>& tensor) {
    if (p.material.model == Model::linear_vector)
      throw std::invalid_argument("fabric solver: springs of vectors (Model I) have no stress");
    if (!_triangles) _triangles.emplace(space, triangle_list(p.mesh, p.material));
    dispatch_model(p.material, [&]<ConstitutiveModel model>() {
      Kokkos::parallel_for(
          "drogue::fabric::stress",
          Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(p.mesh.triangles.size())),
          StressFunctor<ExecutionSpace, model>{.triangles = *_triangles,
                                               .x = x,
                                               .moduli = moduli,
                                               .measure = measure,
                                               .out = to,
                                               .tensor = tensor});
    });
  }

  static void read(const ExecutionSpace& space, const StressView<ExecutionSpace>& from,
                   std::span<Stress> to) {
    const auto mirror = Kokkos::create_mirror_view(from);
    device::copy(space, mirror, from);
    space.fence("drogue::fabric::read_stress");
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = {mirror(i, 0),
               mirror(i, 1),
               {mirror(i, 2), mirror(i, 3), mirror(i, 4)},
               {mirror(i, 5), mirror(i, 6), mirror(i, 7)}};
  }

  std::optional<TriangleViews<ExecutionSpace>> _triangles;
};

}  // namespace drogue::fabric
