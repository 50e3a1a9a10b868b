#pragma once

#include "perf/ladders/springs/spring_rung.hpp"

namespace drogue::perf::ladder {

/// Stiffnesses, kept per vertex and triangle after the lengths at rest.
struct StoredSprings {
  static constexpr int numbers = 5;

  static void set(const SpringProblem& problem, const VertexTriangle& t, double* numbers_of_triangle) {
    stiffnesses(problem, t, inverse_area(t), numbers_of_triangle);
  }
  KOKKOS_FUNCTION static Tensions tensions(const EdgeChanges& change, const double*,
                                           const double* numbers_of_triangle, double, double) {
    return stored_tensions(change, numbers_of_triangle);
  }
};

/// Sheet as a structure of arrays: neighbouring threads read neighbouring numbers. `Springs` keeps some
/// numbers per vertex and triangle besides the squared lengths at rest, and computes tensions.
template <class ExecutionSpace, class Springs>
class SheetOfArrays {
  using Memory = typename ExecutionSpace::memory_space;
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutLeft, Memory>;
  enum { stage_x = 0, stage_v = 6, start = 12, sums = 18, rows = 24 };

 public:
  SheetOfArrays(const SpringProblem& problem, const Numbering& numbering, const ExecutionSpace& space)
      : _two_lambda_mu(problem.two_lambda_mu),
        _mu(problem.mu),
        _state("drogue::perf::ladder::state", numbering.vertices()),
        _mass("drogue::perf::ladder::mass", numbering.vertices()),
        _triangles("drogue::perf::ladder::triangles", numbering.vertices()),
        _neighbours("drogue::perf::ladder::neighbours", numbering.vertices()),
        _numbers("drogue::perf::ladder::springs", numbering.vertices()) {
    const std::size_t n = numbering.vertices();
    std::vector<double> numbers(_numbers.size());
    std::vector<int> neighbours(_neighbours.size()), triangles(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto& around = numbering.triangles[i];
      triangles[i] = numbering.parameters.pinned[i] != 0 ? -1 : static_cast<int>(around.size());
      for (std::size_t t = 0; t < around.size(); ++t) {
        double of_triangle[3 + Springs::numbers] = {around[t].rest[0], around[t].rest[1], around[t].rest[2]};
        Springs::set(problem, around[t], of_triangle + 3);
        for (std::size_t k = 0; k < 3 + Springs::numbers; ++k)
          numbers[(t * (3 + Springs::numbers) + k) * n + i] = of_triangle[k];
        neighbours[2 * t * n + i] = around[t].a, neighbours[(2 * t + 1) * n + i] = around[t].b;
      }
    }
    device::copy_in(space, _numbers, numbers.data(), numbers.size());
    device::copy_in(space, _neighbours, neighbours.data(), neighbours.size());
    device::copy_in(space, _triangles, triangles.data(), n);
    device::copy_in(space, _mass, numbering.parameters.mass.data(), n);
    space.fence("drogue::perf::ladder: springs are copied");
  }

  void upload(const ExecutionSpace& space, const sheet::State& from) {
    const std::size_t n = from.x.size();
    std::vector<double> rows_of_state(_state.size());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        rows_of_state[(stage_x + k) * n + i] = rows_of_state[(start + k) * n + i] = from.x[i][k];
        rows_of_state[(stage_v + k) * n + i] = rows_of_state[(start + 3 + k) * n + i] = from.v[i][k];
      }
    device::copy_in(space, _state, rows_of_state.data(), rows_of_state.size());
    space.fence("drogue::perf::ladder: state is copied");
  }

  [[nodiscard]] std::vector<fabric::Vector> positions(const ExecutionSpace& space) const {
    const std::size_t n = _mass.size();
    std::vector<double> x(3 * n);
    device::copy_out(space, x.data(), _state, x.size());
    space.fence("drogue::perf::ladder: positions are on the host");
    std::vector<fabric::Vector> points;
    for (std::size_t i = 0; i < n; ++i) points.push_back({x[i], x[n + i], x[2 * n + i]});
    return points;
  }

  KOKKOS_FUNCTION Point force(int buffer, int i) const {
    const Point at = point(stage_x + 3 * buffer, i);
    Point sum{0.0, 0.0, 0.0};
    for (int t = 0; t < _triangles(i); ++t) {
      double numbers[3 + Springs::numbers];
      for (int k = 0; k < 3 + Springs::numbers; ++k) numbers[k] = _numbers(i, k, t);
      const TriangleEdges<double> edges(at, point(stage_x + 3 * buffer, _neighbours(i, 0, t)),
                                        point(stage_x + 3 * buffer, _neighbours(i, 1, t)), numbers);
      const Tensions tension = Springs::tensions(edges.change, numbers, numbers + 3, _two_lambda_mu, _mu);
      sum = edges.add_force(sum, tension);
    }
    return sum;
  }
  KOKKOS_FUNCTION Point v(int buffer, int i) const { return point(stage_v + 3 * buffer, i); }
  KOKKOS_FUNCTION Point start_x(int i) const { return point(start, i); }
  KOKKOS_FUNCTION Point start_v(int i) const { return point(start + 3, i); }
  KOKKOS_FUNCTION Point sum_v(int i) const { return point(sums, i); }
  KOKKOS_FUNCTION Point sum_a(int i) const { return point(sums + 3, i); }
  KOKKOS_FUNCTION double mass(int i) const { return _mass(i); }
  KOKKOS_FUNCTION bool is_pinned(int i) const { return _triangles(i) < 0; }
  KOKKOS_FUNCTION void set(int buffer, int i, const Point& x, const Point& v) const {
    put(stage_x + 3 * buffer, i, x), put(stage_v + 3 * buffer, i, v);
  }
  KOKKOS_FUNCTION void set_start(int i, const Point& x, const Point& v) const {
    put(start, i, x), put(start + 3, i, v);
  }
  KOKKOS_FUNCTION void set_sums(int i, const Point& v, const Point& a) const {
    put(sums, i, v), put(sums + 3, i, a);
  }

 private:
  KOKKOS_FUNCTION Point point(int row, int i) const {
    return {_state(i, row), _state(i, row + 1), _state(i, row + 2)};
  }
  KOKKOS_FUNCTION void put(int row, int i, const Point& p) const {
    _state(i, row) = p.x, _state(i, row + 1) = p.y, _state(i, row + 2) = p.z;
  }

  double _two_lambda_mu, _mu;
  Array<double* [rows]> _state;  ///< (vertices, rows)
  Array<double*> _mass;
  Array<int*> _triangles;                                           ///< around a vertex; -1: pinned
  Array<int* [2][most_triangles]> _neighbours;                      ///< (vertices, a or b, triangle)
  Array<double * [3 + Springs::numbers][most_triangles]> _numbers;  ///< (vertices, number, triangle)
};

/// Rung 2. A structure of arrays with the same stored numbers.
///
/// Prediction: none, since the model counts the bytes that are used, and these are the same.
template <class ExecutionSpace>
Rung arrays_rung(const Shared<SpringProblem>& problem) {
  return make_rung<SpringRung<ExecutionSpace, SheetOfArrays<ExecutionSpace, StoredSprings>>>(
      RungText{"arrays", "A structure of arrays: neighbouring threads read neighbouring numbers.",
               "On a host nothing changes: a vertex now gathers its numbers from some eighty lines of "
               "memory, where the structure had them in a dozen, but each line serves the next vertices "
               "too. Arrays pay where neighbouring threads read neighbouring numbers at once, on a GPU "
               "or in packs. On an H100 1.37 times as fast: 46.7 us, after 64.0 us of the structures; "
               "the model has 45.2 us for both (docs/lessons/tables.md)."},
      spring_work(*problem, 1, 8, stored_operations), problem, &SpringProblem::scattered);
}

}  // namespace drogue::perf::ladder
