#pragma once

#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::springs_app {

/// Vertex nearest to a point at rest; the first of several.
int nearest_vertex(const fabric::Mesh& mesh, const std::vector<double>& point);

}  // namespace drogue::springs_app
