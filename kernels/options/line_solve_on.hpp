#pragma once

#include <algorithm>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/options/line_solve.hpp"
#include "kernels/options/solve_lines.hpp"

namespace drogue::options {

template <class ExecutionSpace>
class LineSolveOn final : public linear::BatchSolve {
  using Functor = LineFunctor<ExecutionSpace, 0>;
  using View = typename Functor::View;
  static constexpr int members = Functor::members;

 public:
  explicit LineSolveOn(const Lines& lines)
      : _count(static_cast<int>(lines.lines.size())),
        _groups((_count + members - 1) / members),
        _nodes(lines.nodes),
        _instance(_groups) {
    std::vector<double> factors(numbers(4)), right(numbers(_nodes));
    for (int place = 0; place < _groups * members; ++place) {
      const auto k = static_cast<std::size_t>(std::min(place, _count - 1));
      const Line& line = lines.lines[k];
      const double inverse = 1.0 / pivot(line);
      const double of_line[] = {inverse, line.lower * inverse, line.upper * inverse, line.edge};
      for (int m = 0; m < 4; ++m) factors[at(place, m, 4)] = of_line[m];
      for (int i = 0; i < _nodes; ++i)
        right[at(place, i, _nodes)] =
            lines.right[k * static_cast<std::size_t>(_nodes) + static_cast<std::size_t>(i)];
    }
    _factors = upload(factors);
    _right = upload(right);
    _solution = View("drogue::options::lines", right.size());
  }

  /// The equations are not overwritten.
  void reset() override {}

  void run() override {
    solve_lines(_instance.space(), _groups, _nodes, _factors, _right, _solution);
    _instance.space().fence("drogue::options: lines are solved");
  }

  [[nodiscard]] std::vector<double> solution() override {
    const Kokkos::View<double*, Kokkos::HostSpace> values("drogue::options::lines on the host",
                                                          _solution.size());
    device::copy(_instance.space(), values, _solution);
    _instance.space().fence("drogue::options: the lines' solution is there");
    std::vector<double> rows;
    rows.reserve(static_cast<std::size_t>(_count) * static_cast<std::size_t>(_nodes));
    for (int k = 0; k < _count; ++k)
      for (int i = 0; i < _nodes; ++i) rows.push_back(values(at(k, i, _nodes)));
    return rows;
  }

 private:
  [[nodiscard]] std::size_t numbers(int width) const {
    return static_cast<std::size_t>(_groups * members) * static_cast<std::size_t>(width);
  }
  /// Place of a line's number i of `width`.
  [[nodiscard]] static std::size_t at(int line, int i, int width) {
    return (static_cast<std::size_t>(line / members) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(i)) *
               members +
           static_cast<std::size_t>(line % members);
  }

  [[nodiscard]] View upload(const std::vector<double>& values) const {
    const View there("drogue::options::lines", values.size());
    device::copy_in(_instance.space(), there, values.data(), values.size());
    _instance.space().fence("drogue::options: lines are copied");
    return there;
  }

  int _count, _groups, _nodes;
  device::Instance<ExecutionSpace> _instance;
  View _factors, _right, _solution;
};

template <class ExecutionSpace>
std::unique_ptr<linear::BatchSolve> make_line_solve(const Lines& lines) {
  return std::make_unique<LineSolveOn<ExecutionSpace>>(lines);
}

}  // namespace drogue::options
