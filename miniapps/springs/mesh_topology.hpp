#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::springs_app {

/// Twice the area of a triangle times its unit normal, m^2.
fabric::Vector double_area(const std::vector<fabric::Vector>& points, const std::array<int, 3>& triangle);

/// Whether all triangles have the same normal or its opposite, but for round-off.
bool is_flat(const fabric::Mesh& mesh);

/// Two triangles at an edge that turn in opposite senses, so that their normals point to different sides;
/// none in a mesh with one side up.
std::optional<std::array<int, 2>> opposed_triangles(const fabric::Mesh& mesh);

/// The order in which neighbours lie close together: entry k is the vertex of the file that becomes vertex k
/// (reverse Cuthill and McKee 1969).
std::vector<int> local_order(const fabric::Mesh& mesh);

/// The mesh in that order; triangles and lines stay where they are.
fabric::Mesh renumbered(const fabric::Mesh& mesh, const std::vector<int>& order);

/// What a mesh is like, one line a quantity: sizes, edge lengths, areas, angles.
std::string quality_report(const fabric::Mesh& mesh);

}  // namespace drogue::springs_app
