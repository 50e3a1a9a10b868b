#pragma once

#include <array>
#include <vector>

#include "kernels/coupling/parameters.hpp"

namespace drogue::reference {

using Vector = std::array<double, 3>;

/// Cardinal B-spline of an order n >= 1 (degree n - 1), centred at zero, by the recurrence of Cox and de
/// Boor.
[[nodiscard]] double b_spline(int order, double x);

/// Four-point function of Peskin (Acta Numerica 2002, eq. 6.27).
[[nodiscard]] double peskin_four_point(double x);

/// Values at the faces of each component, axis 0 fastest.
using FaceField = std::array<std::vector<double>, 3>;

/// Number of faces of a component along an axis.
[[nodiscard]] int faces_along(const coupling::StaggeredGrid& grid, std::size_t component, std::size_t axis);

/// Field of zeros.
[[nodiscard]] FaceField zero_field(const coupling::StaggeredGrid& grid);

/// Weights of all faces of a component for a point (m), axis 0 fastest: products of delta functions. Faces
/// beyond a bounded side give their weight to the nearest face.
[[nodiscard]] std::vector<double> face_weights(const coupling::StaggeredGrid& grid,
                                               coupling::DeltaFunction delta, std::size_t component,
                                               const Vector& point);

/// Values at points (m), in the unit of the field.
[[nodiscard]] std::vector<Vector> interpolate(const coupling::StaggeredGrid& grid,
                                              coupling::DeltaFunction delta, const FaceField& field,
                                              const std::vector<Vector>& points);

/// Force densities, N/m^3, of forces (N) on points (m).
[[nodiscard]] FaceField spread(const coupling::StaggeredGrid& grid, coupling::DeltaFunction delta,
                               const std::vector<Vector>& points, const std::vector<Vector>& forces);

/// Row sums of interpolation after spreading over the fluid density (kg/m^3), from areas (m^2): m^2/kg.
[[nodiscard]] std::vector<Vector> spread_row_sums(const coupling::StaggeredGrid& grid,
                                                  coupling::DeltaFunction delta,
                                                  const std::vector<Vector>& points,
                                                  const std::vector<double>& areas, double density);

}  // namespace drogue::reference
