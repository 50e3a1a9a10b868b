#pragma once

#include <optional>
#include <stdexcept>
#include <variant>

#include "kernels/linear/device_communicator.hpp"
#include "kernels/linear/poisson/pencil_solver.hpp"
#include "kernels/linear/poisson/plane_transforms.hpp"
#include "kernels/linear/poisson/slab_factor.hpp"
#include "kernels/linear/poisson/slab_substitution.hpp"

namespace drogue::linear {

/// Direct solver on several ranks that divide z alone: transforms or matrix products along x and y of the
/// planes of a rank, and the partition method along z (`slab_lines.hpp`). No array is transposed: a rank
/// gives the others two numbers per line along z. Each rank holds `unknowns_of` itself.
template <class ExecutionSpace>
class SlabSolver {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Whether a backend has the method along x and y, whatever the cells and conditions along z are. Does not
  /// throw.
  static bool supports(const PoissonProblem& problem, AxisMethod method) {
    return method == AxisMethod::diagonalization || PlaneTransforms<ExecutionSpace>::supports(problem);
  }

  /// Prepares the Laplacian if that is the only operator; others, which may change, are eliminated anew in
  /// each solve. `in_place`: right-hand side and solution are always the same array, or never. Collective on
  /// the group of the communicator, which `ranks` divides; blocks. Throws std::invalid_argument for ranks
  /// that divide another axis, an unsupported method or wrong widths, and std::runtime_error if memory runs
  /// out or a library fails.
  SlabSolver(const ExecutionSpace& space, const PoissonProblem& problem,
             const DeviceCommunicator<ExecutionSpace>& communicator, const PencilRanks& ranks,
             AxisMethod method, InvertedOperators operators = InvertedOperators::any, bool in_place = false)
      : _space(space), _communicator(communicator), _operators(operators), _box(unknowns_of(ranks, problem)) {
    if (ranks.parts[0] * ranks.parts[1] > 1) throw std::invalid_argument("slabs divide the axis z alone");
    const int begin = _box.begin[2], planes = _box.cells[2];
    if (method == AxisMethod::fourier)
      _planes.emplace(std::in_place_type<PlaneTransforms<ExecutionSpace>>, space, problem, planes, in_place);
    else
      _planes.emplace(std::in_place_type<PlaneProducts<ExecutionSpace>>, space, problem, planes, in_place);
    _lines = std::visit(
        [&](const auto& of_planes) {
          return make_slab_lines(space, problem, begin, begin + planes, of_planes.modes());
        },
        *_planes);
    _separators = make_slab_separators(space, _lines, ranks.parts[2], ranks.place[2]);
    _ports = allocate_list(space, "drogue::linear::ports", messages() * _lines.port_count());
    _sources = allocate_list(space, "drogue::linear::sources", messages() * _lines.source_count());
    if (operators == InvertedOperators::laplacian) factor(_lines);
    space.fence("drogue::linear::slab_solver: prepared");
    if (operators == InvertedOperators::laplacian) _ports = _separators.work = List();
  }

  /// True if solves neither block nor allocate. Does not throw.
  [[nodiscard]] bool is_asynchronous() const { return _communicator.is_asynchronous(); }

  /// Applies the inverse of the operator to the right-hand side, which it keeps unless it is in place. For
  /// the Laplacian that is in the unit of the solution per m^2. Arrays of the unknowns of this rank, x
  /// fastest. Collective, and asynchronous if `is_asynchronous`. Throws std::invalid_argument for an array of
  /// the wrong size or an operator that the solver was not made for.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) const {
    if (right_hand_side.extent(0) != _box.size() || solution.extent(0) != _box.size())
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    if (_operators == InvertedOperators::laplacian && spectral_operator.dt != nullptr)
      throw std::invalid_argument("Poisson solver: made for the Laplacian alone");
    SlabLines<ExecutionSpace> lines = _lines;
    if (_operators == InvertedOperators::any) {
      lines.set_operator(spectral_operator);
      factor(lines);
    }
    std::visit(
        [&](const auto& planes) {
          const List coefficients = planes.forward(right_hand_side, solution);
          reduce_slab(_space, lines, coefficients, own(_sources, lines.source_count()));
          gather(_sources, lines.source_count());
          substitute_slab(_space, lines, _separators, coefficients, _sources.data());
          planes.backward(coefficients, solution);
        },
        *_planes);
  }

 private:
  [[nodiscard]] std::int64_t messages() const { return _separators.slabs; }
  /// Place of this rank in a list of the messages of all.
  [[nodiscard]] double* own(const List& all, int count) const {
    return all.data() + static_cast<std::int64_t>(count) * _separators.slab;
  }
  void gather(const List& all, int count) const {
    _communicator.gather(_space, own(all, count), all.data(), static_cast<std::size_t>(count));
  }
  void factor(const SlabLines<ExecutionSpace>& lines) const {
    factor_slab(_space, lines, own(_ports, lines.port_count()));
    gather(_ports, lines.port_count());
    connect_slabs(_space, lines, _separators, _ports.data());
  }

  ExecutionSpace _space;
  DeviceCommunicator<ExecutionSpace> _communicator;
  InvertedOperators _operators;
  CellBox _box;
  std::optional<std::variant<PlaneTransforms<ExecutionSpace>, PlaneProducts<ExecutionSpace>>> _planes;
  SlabLines<ExecutionSpace> _lines;
  SlabSeparators<ExecutionSpace> _separators;
  List _ports, _sources;  ///< messages of all ranks
};

}  // namespace drogue::linear
