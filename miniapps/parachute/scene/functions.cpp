#include "miniapps/parachute/scene/functions.hpp"

#include <algorithm>
#include <sstream>

#include "common/expression/compile.hpp"
#include "common/expression/sample_times.hpp"
#include "common/program/thread_parts.hpp"

namespace drogue::parachute_app {
namespace {

const std::vector<std::string> variables = {"x", "y", "z", "t"};

bool varies(const std::string& text) {
  for (const expression::Instruction& instruction : expression::compile(text, variables))
    if (std::ranges::find(variables, instruction.name) != variables.end()) return true;
  return false;
}

}  // namespace

SpaceTimeFunction::SpaceTimeFunction(const std::string& text)
    : _text(text.empty() ? "0" : text), _expression(_text, variables) {
  if (!varies(_text)) _constant = _expression(std::array{0.0, 0.0, 0.0, 0.0});
}

std::optional<std::array<double, 3>> constant_value(const VectorExpression& text) {
  std::array<double, 3> vector{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double> component = constant_value(text[axis]);
    if (!component) return std::nullopt;
    vector[axis] = *component;
  }
  return vector;
}

std::vector<double> SpaceTimeFunction::sample_times(double end) const {
  return expression::sample_times(_text, variables, end);
}

device::ExpressionProgram device_program(const std::string& text) {
  device::ExpressionBuilder builder;
  for (const auto& [name, value] : expression::compile(text, variables)) builder.push(name, value);
  return builder.program();
}

std::array<int, 3> Lattice::index(std::size_t entry) const {
  const auto row = static_cast<std::size_t>(n[0]), column = static_cast<std::size_t>(n[1]);
  return {static_cast<int>(entry % row), static_cast<int>(entry / row % column),
          static_cast<int>(entry / row / column)};
}

std::array<double, 3> Lattice::place(std::size_t entry) const {
  const std::array<int, 3> at = index(entry);
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = coordinate(axis, at[axis]);
  return result;
}

double Lattice::volume(std::size_t entry) const {
  const std::array<int, 3> at = index(entry);
  double volume = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    volume *= widths[axis][static_cast<std::size_t>(origin[axis] + at[axis])];
  return volume;
}

Lattice lattice_of(const flow::Parameters& p, std::size_t normal) {
  Lattice lattice{flow::extents(p, normal), {}, {}, {0, 0, 0}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int cells = p.cells[axis];
    const bool on_faces = normal == axis && cells > 1,
               is_periodic = p.boundary[2 * axis].kind == flow::BoundaryKind::periodic;
    const double mean = (p.high[axis] - p.low[axis]) / cells;
    const auto width = [&](int i) {  // none beyond the sides
      if (is_periodic) i = (i + cells) % cells;
      return i < 0 || i >= cells ? 0.0 : flow::cell_width(p, axis, i) / mean;
    };
    for (int i = 0; i < lattice.n[axis]; ++i) {
      lattice.coordinates[axis].push_back(on_faces ? flow::face_coordinate(p, axis, i)
                                                   : flow::centre_coordinate(p, axis, i));
      lattice.widths[axis].push_back(on_faces ? 0.5 * (width(i - 1) + width(i)) : width(i));
    }
  }
  return lattice;
}

std::string place_text(const std::array<double, 3>& place) {
  std::ostringstream text;
  text.precision(9);
  text << "(" << place[0] << ", " << place[1] << ", " << place[2] << ")";
  return text.str();
}

std::vector<double> evaluate(const SpaceTimeFunction& function, const Lattice& lattice, double time,
                             std::size_t stride) {
  const std::size_t size = (lattice.size() + stride - 1) / stride;
  if (function.constant()) return std::vector<double>(size, *function.constant());
  std::vector<double> values(size);
  constexpr std::size_t entries_per_thread = 50'000;
  for_thread_parts(thread_parts(size, entries_per_thread), size,
                   [&](std::size_t /*part*/, std::size_t begin, std::size_t end) {
                     SpaceTimeFunction own = function;  // its evaluation changes it
                     for (std::size_t entry = begin; entry < end; ++entry)
                       values[entry] = own(lattice.place(stride * entry), time);
                   });
  return values;
}

}  // namespace drogue::parachute_app
