#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::fabric {

/// Product of a symmetric matrix with `in`, written to `out`.
using LinearOperator = std::function<void(std::span<const double> in, std::span<double> out)>;

/// Lower bound of the largest eigenvalue of a symmetric matrix of `size` rows: the largest Ritz value after
/// `steps` products, from a vector of seeded noise (Lanczos 1950). The loss of orthogonality repeats values
/// and adds none beyond the spectrum (Paige 1980). Throws only what `apply` throws.
[[nodiscard]] double largest_ritz_value(std::size_t size, int steps, const LinearOperator& apply);

/// Evaluates the forces at given positions, m, in N.
using ForceField =
    std::function<void(const std::vector<mesh::Vector>& positions, std::vector<mesh::Vector>& forces)>;

/// Lower bound of the largest angular frequency of small oscillations about `positions`, rad/s: Lanczos'
/// method on central differences of forces with displacements of `displacement`, m. `root_inverse_mass` holds
/// kg^-1/2 for each degree of freedom, 0 for fixed ones. Throws only what `force_at` throws.
[[nodiscard]] double lanczos_frequency(std::span<const double> root_inverse_mass,
                                       const std::vector<mesh::Vector>& positions, double displacement,
                                       const ForceField& force_at);

}  // namespace drogue::fabric
