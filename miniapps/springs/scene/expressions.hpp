#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Vertices at which an expression of the rest coordinates x, y, z is not 0; all for an empty one.
std::vector<int> selected(const std::string& where, const fabric::Mesh& mesh);

/// Values of an expression of x, y, z and t at every vertex; 0 for an empty one.
std::vector<double> values_at(const std::string& expression, const fabric::Mesh& mesh, double time = 0.0);

/// Values of three expressions at every vertex.
std::vector<fabric::Vector> values_at(const ExpressionVector& expressions, const fabric::Mesh& mesh,
                                      double time = 0.0);

/// True if an expression depends on the time.
bool depends_on_time(const std::string& expression);

/// Times of a run of `end`, s, at which to check an expression.
std::vector<double> sample_times(const std::string& expression, double end);

/// Device program of an expression of x, y, z and t. Throws std::invalid_argument if it is too long.
device::ExpressionProgram device_program(const std::string& expression);

/// Value of an expression without variables.
std::optional<double> constant_value(const std::string& expression);

}  // namespace drogue::springs_app
