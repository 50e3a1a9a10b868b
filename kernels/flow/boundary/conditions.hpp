#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/device/copy.hpp"
#include "kernels/device/expression.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Conditions of the sides on a device. Values of a side whose velocity is an expression stand in a table
/// with an entry for every point of the side, ghost cells included. Expressions are evaluated only at points
/// of the domain: ghost cells beyond a periodic axis have the value of the point that they repeat, and those
/// beyond another side of the domain extrapolate the two outermost points linearly. Only ghost cells beyond
/// two sides use these.
template <class ExecutionSpace>
struct BoundaryConditions {
  BoundaryKind kind[6];
  double velocity[6][3];       ///< m/s; on outflows that of the fluid outside
  std::int64_t first[6];       ///< first entry of a side in `table`; -1: no table
  List<ExecutionSpace> table;  ///< m/s

  /// Axes of the table of a side: the two other than its own, in ascending order.
  [[nodiscard]] KOKKOS_FUNCTION static int first_axis(int axis) { return axis == 0 ? 1 : 0; }
  [[nodiscard]] KOKKOS_FUNCTION static int second_axis(int axis) { return axis == 2 ? 1 : 2; }

  /// Prescribed velocity component at the point of a side next to cell `index`, m/s.
  [[nodiscard]] KOKKOS_FUNCTION double value(const MacGrid& g, int side, int component,
                                             const int index[3]) const {
    if (first[side] < 0) return velocity[side][component];
    const int axis = side / 2, a = first_axis(axis), b = second_axis(axis);
    const std::int64_t row = g.n[a] + 2 * g.ghost[a], rows = g.n[b] + 2 * g.ghost[b];
    return table(static_cast<std::size_t>(first[side] + component * row * rows +
                                          (index[b] + g.ghost[b]) * row + index[a] + g.ghost[a]));
  }
};

/// True if an expression depends on t. Does not throw.
inline bool changes_in_time(const device::ExpressionProgram& program) {
  return std::find(program.operations, program.operations + program.length, device::Operation::t) !=
         program.operations + program.length;
}

/// True if a prescribed velocity is an expression of t. Does not throw.
inline bool change_in_time(const std::array<Boundary, 6>& sides) {
  for (const Boundary& side : sides)
    for (const device::ExpressionProgram& program : side.velocity_expressions)
      if (changes_in_time(program)) return true;
  return false;
}

/// Time at which the sides need their values: that of the step's beginning plus this part of dt.
struct BoundaryTime {
  double fraction;
  bool initial;  ///< true before the first step: dt is not known
};

/// Component and point of an entry of the table of a side.
struct TableEntry {
  int component;
  int axis[2];   ///< of the table
  int index[2];  ///< in the whole grid, ghost cells included, along these axes

  /// True next to a cell of the domain.
  [[nodiscard]] KOKKOS_FUNCTION bool is_beside_cell(const MacGrid& g) const {
    return index[0] >= 0 && index[0] < g.whole[axis[0]] && index[1] >= 0 && index[1] < g.whole[axis[1]];
  }
};

/// Entry of the table of a side by its number.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION TableEntry table_entry(const MacGrid& g, int side, int entry) {
  using Conditions = BoundaryConditions<ExecutionSpace>;
  const int a = Conditions::first_axis(side / 2), b = Conditions::second_axis(side / 2);
  const int row = g.n[a] + 2 * g.ghost[a], rows = g.n[b] + 2 * g.ghost[b];
  return {entry / (row * rows),
          {a, b},
          {g.origin[a] + entry % row - g.ghost[a], g.origin[b] + entry / row % rows - g.ghost[b]}};
}

/// Points of the domain along an axis that give a value of a component at an index: 1 - `weight` times the
/// value at `index` plus `weight` times that at the next one.
struct TableSupport {
  int index;
  double weight;
};

/// Support of a component on a side at an index along another axis; see `BoundaryConditions`.
KOKKOS_INLINE_FUNCTION TableSupport table_support(const MacGrid& g, int axis, int component, int index) {
  const int n = g.whole[axis];
  if (g.whole_periodic[axis]) return {(index + n) % n, 0.0};
  // A component lies on the faces of its own axis.
  const int last = component == axis ? n : n - 1;
  if (index < 0) return {0, static_cast<double>(index)};
  return index > last ? TableSupport{last - 1, index - last + 1.0} : TableSupport{index, 0.0};
}

/// Evaluates the expressions of a side for the entries of its table, and checks that the velocity is finite.
/// At the end of a step it reduces the acceleration since the last evaluation.
template <class ExecutionSpace>
struct BoundaryTableFunctor {
  MacGrid grid;
  List<ExecutionSpace> table;
  Kokkos::View<device::ExpressionProgram*, typename ExecutionSpace::memory_space> programs;  ///< three
  ControlView<ExecutionSpace> control;
  BoundaryTime stage;
  int side;
  std::int64_t first;
  const stepping::MotionInterval* motion;  ///< of the sides, in memory of the backend
  int motions;                             ///< number of its intervals; 0 without any

  KOKKOS_FUNCTION void operator()(const int entry) const {
    Control& c = control();
    if (!stage.initial && c.trial.stop != stepping::Stop::running) return;
    const double end = stage.initial ? c.now.time : c.now.time + stage.fraction * c.trial.dt,
                 t = stepping::time_before_jump(motion, motions, end);
    const MacGrid& g = grid;
    const TableEntry at = table_entry<ExecutionSpace>(g, side, entry);
    const int component = at.component, axis = side / 2;
    const TableSupport support[2] = {table_support(g, at.axis[0], component, at.index[0]),
                                     table_support(g, at.axis[1], component, at.index[1])};
    double point[3], value = 0.0;
    point[axis] = side % 2 == 0 ? g.low[axis] : g.high[axis];
    for (int corner = 0; corner < 4; ++corner) {
      double weight = 1.0;
      for (int i = 0; i < 2; ++i) {
        const bool is_next = (corner >> i) % 2 == 1;
        weight *= is_next ? support[i].weight : 1.0 - support[i].weight;
        point[at.axis[i]] =
            g.coordinate(at.axis[i], support[i].index + (is_next ? 1 : 0), component == at.axis[i]);
      }
      if (weight == 0.0) continue;
      const device::ExpressionProgram& program = programs(static_cast<std::size_t>(component));
      value += weight * device::evaluate(program, point[0], point[1], point[2], t);
      // A pole is no jump: it stays not finite.
      if (t != end) value += 0.0 * device::evaluate(program, point[0], point[1], point[2], end);
    }
    double& stored = table(static_cast<std::size_t>(first + entry));
    const double change = Kokkos::fabs(value - stored);
    stored = value;
    if (!Kokkos::isfinite(value)) Kokkos::atomic_max(&c.failed_side, side + 1);
    if (stage.initial || stage.fraction < 1.0 || g.n[component] == 1 || !at.is_beside_cell(g)) return;
    raise(c.side_acceleration[component],
          Kokkos::bit_cast<std::uint64_t>(change * g.inverse_h[component] / c.trial.dt));
  }
};

/// Boundary conditions with the programs that fill their tables.
template <class ExecutionSpace>
class BoundaryTables {
 public:
  using Programs = Kokkos::View<device::ExpressionProgram*, typename ExecutionSpace::memory_space>;

  /// Allocates the tables; blocks. Throws std::runtime_error if memory runs out.
  BoundaryTables(const ExecutionSpace& space, const MacGrid& grid, const std::array<Boundary, 6>& sides)
      : _grid(grid), _changes(change_in_time(sides)) {
    std::int64_t entries = 0;
    for (std::size_t side = 0; side < 6; ++side) {
      _conditions.kind[side] = sides[side].kind;
      for (std::size_t c = 0; c < 3; ++c) _conditions.velocity[side][c] = sides[side].velocity[c];
      _conditions.first[side] = -1;
      if (sides[side].velocity_expressions.empty()) continue;
      _conditions.first[side] = entries;
      entries += entries_of(static_cast<int>(side));
      _programs[side] = Programs(
          Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::flow::boundary_programs"), 3);
      device::copy_in(space, _programs[side], sides[side].velocity_expressions.data(), 3);
    }
    _conditions.table =
        List<ExecutionSpace>("drogue::flow::boundary_table", static_cast<std::size_t>(entries));
    space.fence("drogue::flow::boundary: allocated");
  }

  [[nodiscard]] const BoundaryConditions<ExecutionSpace>& conditions() const { return _conditions; }
  /// Sets the velocity of a side without expressions, m/s. Functors that exist keep the old one. Does not
  /// throw.
  void set_velocity(std::size_t side, const std::array<double, 3>& velocity) {
    for (std::size_t c = 0; c < 3; ++c) _conditions.velocity[side][c] = velocity[c];
  }
  /// True if a prescribed velocity is an expression of t.
  [[nodiscard]] bool changes() const { return _changes; }

  /// Enqueues the evaluation of all tables. Asynchronous.
  void enqueue_evaluation(const ExecutionSpace& space, const ControlView<ExecutionSpace>& control,
                          const StepConstants& constants, const BoundaryTime& stage) const {
    for (int side = 0; side < 6; ++side) {
      if (_conditions.first[side] < 0) continue;
      device::launch_each(space, "drogue::flow::boundary_table", static_cast<int>(entries_of(side)),
                          BoundaryTableFunctor<ExecutionSpace>{.grid = _grid,
                                                               .table = _conditions.table,
                                                               .programs = _programs[side],
                                                               .control = control,
                                                               .stage = stage,
                                                               .side = side,
                                                               .first = _conditions.first[side],
                                                               .motion = constants.motion,
                                                               .motions = constants.motions});
    }
  }

 private:
  [[nodiscard]] std::int64_t entries_of(int side) const {
    std::int64_t entries = 3;
    for (int a = 0; a < 3; ++a)
      if (a != side / 2) entries *= _grid.n[a] + 2 * _grid.ghost[a];
    return entries;
  }

  MacGrid _grid;
  BoundaryConditions<ExecutionSpace> _conditions{};
  Programs _programs[6];
  bool _changes;
};

}  // namespace drogue::flow
