#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// No line.
inline constexpr int no_line = std::numeric_limits<int>::max();

/// Lines of finite strength, in their order in the mesh.
template <class ExecutionSpace>
struct LimitedLines {
  template <class T>
  using List = fabric::ListView<ExecutionSpace, T>;

  List<int> number;  ///< in the mesh
  fabric::TableView<ExecutionSpace, int, 2> ends;
  List<double> stiffness, length, strength;                         ///< E A, N; without tension, m; N
  Kokkos::View<int, typename ExecutionSpace::memory_space> broken;  ///< least number, or `no_line`
};

/// Records the first line whose tension exceeds its strength.
template <class ExecutionSpace>
struct CheckLinesFunctor {
  LimitedLines<ExecutionSpace> lines;
  fabric::PointsView<ExecutionSpace> x;

  KOKKOS_FUNCTION void operator()(const int k) const {
    const spatial::Point along =
        spatial::load_vector(x, lines.ends(k, 1)) - spatial::load_vector(x, lines.ends(k, 0));
    const double strain = device::square_root(dot(along, along)) / lines.length(k) - 1.0;
    if (lines.stiffness(k) * strain > lines.strength(k)) Kokkos::atomic_min(&lines.broken(), lines.number(k));
  }
};

/// Detects lines that carry more than their strength.
template <class ExecutionSpace>
class LineStrength {
 public:
  /// Blocks. Throws std::invalid_argument for a strength that is not positive, and for a number of strengths
  /// other than that of the lines or none.
  LineStrength(const ExecutionSpace& space, const Parameters& p)
      : _broken("drogue::coupling::broken_line"), _failed("drogue::coupling::failed_line") {
    const fabric::Mesh& mesh = p.fabric.mesh;
    if (!p.line_strength.empty() && p.line_strength.size() != mesh.lines.size())
      throw std::invalid_argument("coupled solver: there must be a strength for every line, or for none");
    std::vector<int> number;
    std::array<std::vector<int>, 2> ends;
    std::vector<double> length, strength;
    for (std::size_t k = 0; k < p.line_strength.size(); ++k) {
      if (!(p.line_strength[k] > 0.0))
        throw std::invalid_argument("coupled solver: the strength of a line must be positive");
      if (std::isinf(p.line_strength[k])) continue;
      number.push_back(static_cast<int>(k));
      for (std::size_t end = 0; end < 2; ++end) ends[end].push_back(mesh.lines[k][end]);
      length.push_back(mesh::rest_length(mesh, k));
      strength.push_back(p.line_strength[k]);
    }
    _lines = {.number = fabric::list_view(space, "drogue::coupling::limited_lines", number),
              .ends = fabric::table_view(space, "drogue::coupling::limited_ends", ends),
              .stiffness = fabric::list_view(space, "drogue::coupling::limited_stiffness", strength),
              .length = fabric::list_view(space, "drogue::coupling::limited_length", length),
              .strength = fabric::list_view(space, "drogue::coupling::line_strength", strength),
              .broken = _broken};
    _numbers = number;
    reset(space);
  }

  /// Sets E A of every line of the mesh, N. Blocks.
  void set_stiffness(const ExecutionSpace& space, std::span<const double> of_lines) {
    const auto mirror = Kokkos::create_mirror_view(_lines.stiffness);
    for (std::size_t k = 0; k < _numbers.size(); ++k)
      mirror(k) = of_lines[static_cast<std::size_t>(_numbers[k])];
    Kokkos::deep_copy(space, _lines.stiffness, mirror);
    space.fence("drogue::coupling::set_stiffness");
  }

  /// Forgets broken lines. Asynchronous.
  void reset(const ExecutionSpace& space) const {
    Kokkos::deep_copy(space, _broken, no_line);
    Kokkos::deep_copy(space, _failed, no_line);
  }

  /// Enqueues the check of all lines at positions, m.
  void check(const ExecutionSpace& space, const fabric::PointsView<ExecutionSpace>& positions) const {
    if (_numbers.empty()) return;
    device::launch_each(space, "drogue::coupling::check_lines", static_cast<int>(_numbers.size()),
                        CheckLinesFunctor<ExecutionSpace>{_lines, positions});
  }

  /// Line that the last check has found, and the one that has ended the run. Does not throw.
  [[nodiscard]] const Kokkos::View<int, typename ExecutionSpace::memory_space>& broken() const {
    return _broken;
  }
  [[nodiscard]] const Kokkos::View<int, typename ExecutionSpace::memory_space>& failed() const {
    return _failed;
  }

 private:
  Kokkos::View<int, typename ExecutionSpace::memory_space> _broken, _failed;
  LimitedLines<ExecutionSpace> _lines;
  std::vector<int> _numbers;
};

}  // namespace drogue::coupling
