#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/linear/poisson/problem.hpp"

namespace drogue::linear {

/// Copies a host vector to a new View; blocks.
template <class ExecutionSpace>
Kokkos::View<double*, typename ExecutionSpace::memory_space> to_device(const ExecutionSpace& space,
                                                                       const std::string& label,
                                                                       const std::vector<double>& values) {
  Kokkos::View<double*, typename ExecutionSpace::memory_space> view(
      Kokkos::view_alloc(space, Kokkos::WithoutInitializing, label), values.size());
  device::copy_in(space, view, values.data(), values.size());
  space.fence("drogue::linear::to_device");
  return view;
}

/// Operator whose inverse a direct solver applies: the Laplacian, or 1 - diffusivity dt lap, the operator of
/// an implicit step of diffusion.
struct SpectralOperator {
  const double* dt =
      nullptr;  ///< s, in device memory, so that it may change from step to step; null: Laplacian
  double diffusivity = 0.0;  ///< m^2/s

  /// Factor of the inverse for an eigenvalue (1/m^2) of the Laplacian. Zero if the inverse does not exist.
  [[nodiscard]] KOKKOS_FUNCTION double inverse(double eigenvalue) const {
    if (dt != nullptr) return 1.0 / (1.0 - diffusivity * *dt * eigenvalue);
    return eigenvalue < 0.0 ? 1.0 / eigenvalue : 0.0;
  }
};

/// Multiplies spectral coefficients by the inverse of an operator and by the normalisation of a pair of
/// transforms. `parts` consecutive numbers belong to one mode: 2 for complex coefficients, else 1.
template <class ExecutionSpace>
struct SpectralScalingFunctor {
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  double* coefficients;
  List x, y, z;  ///< eigenvalues along the axes, 1/m^2
  int parts;
  double normalisation;
  SpectralOperator spectral_operator;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const double factor = normalisation * spectral_operator.inverse(x(i) + y(j) + z(k));
    const std::int64_t at =
        ((static_cast<std::int64_t>(k) * y.extent_int(0) + j) * x.extent_int(0) + i) * parts;
    for (int part = 0; part < parts; ++part) coefficients[at + part] *= factor;
  }
};

template <class ExecutionSpace>
void scale_spectrum(const ExecutionSpace& space, const SpectralScalingFunctor<ExecutionSpace>& functor) {
  const int modes[3] = {functor.x.extent_int(0), functor.y.extent_int(0), functor.z.extent_int(0)};
  device::launch_cells(space, "drogue::linear::scale_spectrum", modes, functor);
}

}  // namespace drogue::linear
