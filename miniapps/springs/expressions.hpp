#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// The vertices at which an expression of x, y, z at rest is not 0; all for an empty one.
std::vector<int> selected(const std::string& where, const fabric::Mesh& mesh);

/// An expression of x, y, z and t at every vertex; 0 for an empty one.
std::vector<double> values_at(const std::string& expression, const fabric::Mesh& mesh, double time = 0.0);

/// Three of them.
std::vector<fabric::Vector> values_at(const ExpressionVector& expressions, const fabric::Mesh& mesh,
                                      double time = 0.0);

/// Whether an expression names the time.
bool depends_on_time(const std::string& expression);

/// An expression of x, y, z and t for kernels. Throws std::invalid_argument where it is too long for them.
device::ExpressionProgram device_program(const std::string& expression);

/// The value of an expression that names no variable.
std::optional<double> constant_value(const std::string& expression);

}  // namespace drogue::springs_app
