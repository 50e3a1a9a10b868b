#pragma once

#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::springs_app {

/// The sum of the lengths of all lines, m, and of the areas of all triangles, m^2, their vertices at `x`.
double total_length(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x);
double total_area(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x);

/// Mean over time of the absolute difference of two quantities at the same times, by the trapezoidal rule;
/// at one time alone the difference itself.
double mean_difference(const std::vector<double>& time, const std::vector<double>& a,
                       const std::vector<double>& b);

}  // namespace drogue::springs_app
