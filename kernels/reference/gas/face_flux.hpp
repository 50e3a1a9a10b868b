#pragma once

#include <array>
#include <span>

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Maximum wave speeds over a set of cells.
struct SpeedBounds {
  std::array<double, 3> field{};  ///< of |u-c|, |u|, |u+c|, m/s
  double largest = 0.0;           ///< of |u|+c, m/s
};

[[nodiscard]] SpeedBounds speed_bounds(std::span<const Conserved> cells, double gamma);

/// Alpha of each characteristic field at a face, m/s: the maximum over the mesh, or over the stencil for
/// lf_stencil. Does not throw.
[[nodiscard]] std::array<double, 3> splitting_alpha(gas::Splitting splitting, const SpeedBounds& mesh,
                                                    std::span<const Conserved, 6> stencil, double gamma);

/// Characteristic WENO flux at i+1/2 from the cells i-2 .. i+3 in dense form, SI units. All states and fluxes
/// of the stencil are projected with full matrices, split as F+- = (F +- alpha U)/2, reconstructed and
/// projected back. `alpha` in m/s. Does not throw.
[[nodiscard]] Conserved face_flux(std::span<const Conserved, 6> stencil, const std::array<double, 3>& alpha,
                                  const gas::Parameters& parameters);

/// First-order Lax-Friedrichs flux with a single alpha, m/s. Does not throw.
[[nodiscard]] Conserved lax_friedrichs_flux(const Conserved& a, const Conserved& b, double alpha,
                                            double gamma);

}  // namespace drogue::reference
