#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/expression/expression.hpp"
#include "kernels/device/expression_program.hpp"
#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/solver.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Function of place and time on the host, from an expression of x, y, z and t in SI units. Not thread-safe:
/// every thread needs a copy.
class SpaceTimeFunction {
 public:
  /// 0 for an empty text. Throws `expression::ExpressionError` for an invalid expression.
  explicit SpaceTimeFunction(const std::string& text);

  /// Value for all places and times; nothing if it varies. Does not throw.
  [[nodiscard]] const std::optional<double>& constant() const { return _constant; }

  /// Times of a run of `end`, s, at which to check it. Throws only std::bad_alloc.
  [[nodiscard]] std::vector<double> sample_times(double end) const;

  /// Value at a place, m, and a time, s; not finite where the expression is undefined. Does not throw.
  double operator()(const std::array<double, 3>& place, double time) const {
    return _constant ? *_constant : _expression(std::array{place[0], place[1], place[2], time});
  }

 private:
  std::string _text;
  expression::Expression _expression;
  std::optional<double> _constant;
};

/// Vector of three such functions, such as a velocity.
class SpaceTimeVector {
 public:
  /// Throws as `SpaceTimeFunction`.
  explicit SpaceTimeVector(const VectorExpression& text)
      : _components{SpaceTimeFunction(text[0]), SpaceTimeFunction(text[1]), SpaceTimeFunction(text[2])} {}

  /// As that of a component.
  std::array<double, 3> operator()(const std::array<double, 3>& place, double time) const {
    return {_components[0](place, time), _components[1](place, time), _components[2](place, time)};
  }

 private:
  std::array<SpaceTimeFunction, 3> _components;
};

/// Middle of the domain, m. Does not throw.
[[nodiscard]] inline std::array<double, 3> middle_of(const flow::Parameters& p) {
  return {0.5 * (p.low[0] + p.high[0]), 0.5 * (p.low[1] + p.high[1]), 0.5 * (p.low[2] + p.high[2])};
}

/// Value of an expression for all places and times; nothing if it varies. Throws as `SpaceTimeFunction`.
[[nodiscard]] inline std::optional<double> constant_value(const std::string& text) {
  return SpaceTimeFunction(text).constant();
}

/// The same of three expressions. Throws as `SpaceTimeFunction`.
[[nodiscard]] std::optional<std::array<double, 3>> constant_value(const VectorExpression& text);

/// Program of an expression for kernels. Throws std::invalid_argument if it is too long.
[[nodiscard]] device::ExpressionProgram device_program(const std::string& text);

/// Points of an array of the state, or of a part of it: `n` along each axis. Entry i + n[0] (j + n[1] k) is
/// at point `origin` + (i, j, k) of the whole array.
struct Lattice {
  std::array<int, 3> n;
  std::array<std::vector<double>, 3> coordinates;  ///< of all points of the whole array along each axis, m
  /// Widths of the parts of each axis that these points stand for, over the mean width of a cell.
  std::array<std::vector<double>, 3> widths;
  std::array<int, 3> origin = {0, 0, 0};

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
  }
  [[nodiscard]] std::array<int, 3> index(std::size_t entry) const;
  [[nodiscard]] double coordinate(std::size_t axis, int index) const {
    return coordinates[axis][static_cast<std::size_t>(origin[axis] + index)];
  }
  [[nodiscard]] std::array<double, 3> place(std::size_t entry) const;
  /// Volume that an entry stands for, over the mean volume of a cell.
  [[nodiscard]] double volume(std::size_t entry) const;
};

/// Cell centres, or the faces normal to an axis, coordinates in m. Throws only std::bad_alloc.
[[nodiscard]] Lattice lattice_of(const flow::Parameters& parameters, std::size_t normal = flow::at_cells);

/// "(x, y, z)" of a place, m. Throws only std::bad_alloc.
[[nodiscard]] std::string place_text(const std::array<double, 3>& place);

/// Values of a function at every `stride`-th point of a lattice, computed by one thread per core. Throws
/// std::bad_alloc.
[[nodiscard]] std::vector<double> evaluate(const SpaceTimeFunction& function, const Lattice& lattice,
                                           double time, std::size_t stride = 1);

}  // namespace drogue::parachute_app
