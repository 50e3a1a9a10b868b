#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/poisson/pencil_transpose.hpp"

namespace drogue::linear {

/// How a direct solver transforms along an axis.
enum class AxisMethod {
  fourier,          ///< `AxisTransforms`, on hosts
  diagonalization,  ///< products with the matrices of eigenvectors
};

/// Unknowns of a rank in a problem: the cells of `box_of(ranks, problem.cells)`. Along an axis with unknowns
/// on faces, those on the low faces of its cells in the grid of cells; the first face is no unknown. Does not
/// throw.
[[nodiscard]] inline CellBox unknowns_of(const PencilRanks& ranks, const PoissonProblem& problem) {
  std::array<int, 3> cells = problem.cells;
  for (std::size_t axis = 0; axis < 3; ++axis) cells[axis] += problem.axes[axis].on_inner_faces() ? 1 : 0;
  CellBox box = box_of(ranks, cells);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!problem.axes[axis].on_inner_faces()) continue;
    int& changed = box.begin[axis] == 0 ? box.cells[axis] : box.begin[axis];
    --changed;
  }
  return box;
}

/// Direct solver on several ranks: transforms along x, y and z in turn, with transpositions between boxes
/// that hold whole lines along each axis (pencils). Each rank holds `unknowns_of` itself.
template <class ExecutionSpace>
class PencilSolver {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Collective on `group`, which `ranks` divides; blocks. On CUDA and for cells of different widths only
  /// diagonalization works, and std::invalid_argument is thrown otherwise. Throws std::runtime_error if
  /// memory runs out.
  PencilSolver(const ExecutionSpace& space, const PoissonProblem& problem, const RankGroup& group,
               const PencilRanks& ranks, AxisMethod method)
      : _space(space), _method(method), _product(space) {
    if (method == AxisMethod::fourier) refuse_stretched(problem);
    if (method == AxisMethod::fourier && !device::is_host<ExecutionSpace>)
      throw std::invalid_argument("the Fourier solver on CUDA works on one rank");
    const RankGroup rows = group.split(ranks.place[2]), columns = group.split(ranks.place[1]);
    _boxes[0] = unknowns_of(ranks, problem);
    // The lines along z must not be divided further.
    turn(0, rows, problem, 0);
    turn(1, columns, problem, _boxes[1].cells[1] >= _boxes[1].cells[0] ? 1 : 0);
    std::size_t most = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      make_transforms(problem, axis);
      most = std::max(most, _boxes[axis].size());
    }
    for (List& array : _arrays)
      array = List(Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::linear::pencils"), most);
    _send = HostBuffer<ExecutionSpace>("drogue::linear::pencils_sent", most);
    _receive = HostBuffer<ExecutionSpace>("drogue::linear::pencils_received", most);
    space.fence("drogue::linear::pencil_solver: allocated");
  }

  /// Transpositions wait for the host. Does not throw.
  [[nodiscard]] static constexpr bool is_asynchronous() { return false; }

  /// Applies the inverse of the operator to the right-hand side, which it keeps. For the Laplacian that is in
  /// the unit of the solution per m^2. Arrays of the unknowns of this rank, x fastest. Collective; blocks
  /// until the last transposition. Throws std::invalid_argument for an array of the wrong size.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) {
    const std::size_t cells = _boxes[0].size();
    if (right_hand_side.extent(0) != cells || solution.extent(0) != cells)
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    device::copy(_space, List(_arrays[0].data(), cells), right_hand_side);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      transform(axis, true);
      if (axis < 2 && _turns[axis]) {
        _turns[axis]->forward(_space, _arrays[0], _arrays[1], _send, _receive);
        std::swap(_arrays[0], _arrays[1]);
      }
    }
    if (_boxes[2].size() > 0)
      scale_spectrum(_space, SpectralScalingFunctor<ExecutionSpace>{.coefficients = _arrays[0].data(),
                                                                    .x = _eigenvalues[0],
                                                                    .y = _eigenvalues[1],
                                                                    .z = _eigenvalues[2],
                                                                    .parts = 1,
                                                                    .normalisation = _normalisation,
                                                                    .spectral_operator = spectral_operator});
    for (std::size_t axis = 3; axis-- > 0;) {
      transform(axis, false);
      if (axis > 0 && _turns[axis - 1]) {
        _turns[axis - 1]->backward(_space, _arrays[0], _arrays[1], _send, _receive);
        std::swap(_arrays[0], _arrays[1]);
      }
    }
    device::copy(_space, solution, List(_arrays[0].data(), cells));
  }

 private:
  /// Sets the box with whole lines along the axis after `from`, which the ranks of `group` divide.
  void turn(std::size_t from, const RankGroup& group, const PoissonProblem& problem, std::size_t split) {
    const std::size_t gathered = from + 1;
    _boxes[gathered] = _boxes[from];
    if (group.size() == 1) return;
    _turns[from].emplace(group, _boxes[from], gathered, problem.cells[gathered], split,
                         problem.axes[gathered].on_inner_faces() ? 1 : 0);
    _boxes[gathered] = _turns[from]->after();
  }

  void make_transforms(const PoissonProblem& problem, std::size_t axis) {
    _has_one_cell[axis] = !problem.varies_along(axis);
    AxisModes modes;
    if (_method == AxisMethod::fourier)
      modes.eigenvalues = transform_eigenvalues(problem, axis);
    else
      modes = axis_modes(problem, axis);
    // Scaling takes place in the last box.
    const auto begin = modes.eigenvalues.begin() + _boxes[2].begin[axis];
    _eigenvalues[axis] = to_device(_space, "drogue::linear::eigenvalues",
                                   std::vector<double>(begin, begin + _boxes[2].cells[axis]));
    if (_has_one_cell[axis]) return;
    if (_method == AxisMethod::diagonalization) {
      _basis[axis] = to_device(_space, modes);
    } else if constexpr (device::is_host<ExecutionSpace>) {
      _transforms[axis] = AxisTransforms<ExecutionSpace>(_boxes[axis].cells, axis, problem.axes[axis], false);
      _normalisation *= _transforms[axis].normalisation();
    }
  }

  void transform(std::size_t axis, bool forward) {
    if (_has_one_cell[axis] || _boxes[axis].size() == 0) return;
    if (_method == AxisMethod::diagonalization) {
      _product.along_axis(_boxes[axis].cells, axis, forward ? _basis[axis].forward : _basis[axis].backward,
                          forward, _arrays[0], _arrays[1]);
      std::swap(_arrays[0], _arrays[1]);
    } else if constexpr (device::is_host<ExecutionSpace>) {
      if (forward)
        _transforms[axis].forward(_space, _arrays[0].data(), _arrays[0].data());
      else
        _transforms[axis].backward(_space, _arrays[0].data());
    }
  }

  /// Transforms of hosts; nothing on a device.
  struct NoTransforms {};
  using Transforms =
      std::conditional_t<device::is_host<ExecutionSpace>, AxisTransforms<ExecutionSpace>, NoTransforms>;

  ExecutionSpace _space;
  AxisMethod _method;
  DenseProduct<ExecutionSpace> _product;
  CellBox _boxes[3];  ///< with whole lines along each axis
  std::optional<PencilTranspose<ExecutionSpace>> _turns[2];
  bool _has_one_cell[3] = {};
  Transforms _transforms[3];
  double _normalisation = 1.0;
  AxisBasis<ExecutionSpace> _basis[3];
  List _eigenvalues[3];
  List _arrays[2];  ///< values at present, and room for the next
  HostBuffer<ExecutionSpace> _send, _receive;
};

}  // namespace drogue::linear
