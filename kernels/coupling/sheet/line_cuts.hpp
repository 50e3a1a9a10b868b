#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"

namespace drogue::coupling {

/// Stiffness of the lines of a cloth, some of which are cut at given times, as a function of time.
class LineCuts {
 public:
  /// Throws std::invalid_argument for a time that is not positive and finite, and for lines that the mesh
  /// lacks.
  LineCuts(const std::vector<LineCut>& cuts, const fabric::Parameters& fabric)
      : _cuts(cuts), _whole(fabric.mesh.line_stiffness) {
    const std::size_t lines = fabric.mesh.lines.size();
    if (_whole.empty()) _whole.assign(lines, fabric.material.axial_stiffness);
    for (const LineCut& cut : _cuts) {
      if (!(cut.time > 0.0 && std::isfinite(cut.time)))
        throw std::invalid_argument("cuts of lines: the time of a cut must be positive and finite");
      for (const int line : cut.lines)
        if (line < 0 || static_cast<std::size_t>(line) >= lines)
          throw std::invalid_argument("cuts of lines: a line that is cut must be one of the mesh");
    }
    std::ranges::stable_sort(_cuts, {}, &LineCut::time);
  }

  /// E A of every line after the cuts so far, N. Throws only std::bad_alloc.
  [[nodiscard]] std::vector<double> stiffness() const {
    std::vector<double> result = _whole;
    for (std::size_t k = 0; k < _done; ++k)
      for (const int line : _cuts[k].lines) result[static_cast<std::size_t>(line)] = 0.0;
    return result;
  }

  /// Time of the next cut, s; infinite after the last one. Does not throw.
  [[nodiscard]] double next() const {
    return _done < _cuts.size() ? _cuts[_done].time : std::numeric_limits<double>::infinity();
  }

  /// Makes the cuts that are due at a time, s. Returns true if there are any. Does not throw.
  bool cut_until(double time) {
    const std::size_t before = _done;
    while (next() <= time) ++_done;
    return _done > before;
  }

  /// Returns to the cuts before a time, s, without those at it: their block has not begun. Returns true if
  /// the stiffness changes. Does not throw.
  bool restart_at(double time) {
    const std::size_t before = _done;
    _done = 0;
    while (next() < time) ++_done;
    return _done != before;
  }

 private:
  std::vector<LineCut> _cuts;  ///< in the order of their times
  std::vector<double> _whole;  ///< N
  std::size_t _done = 0;
};

}  // namespace drogue::coupling
