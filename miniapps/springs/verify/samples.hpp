#pragma once

#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::springs_app {

/// Total length of all lines, m, and total area of all triangles, m^2, for vertices at `x`.
double total_length(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x);
double total_area(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x);

/// Time average of |a - b| by the trapezoidal rule; for a single time the difference itself.
double mean_difference(const std::vector<double>& time, const std::vector<double>& a,
                       const std::vector<double>& b);

}  // namespace drogue::springs_app
