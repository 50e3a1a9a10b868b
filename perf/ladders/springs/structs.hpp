#pragma once

#include "perf/ladders/springs/spring_rung.hpp"

namespace drogue::perf::ladder {

/// Sheet as an array of structures: everything of a vertex in one place.
template <class ExecutionSpace>
class SheetOfStructs {
 public:
  struct Spring {
    int a, b;
    double rest[3], stiffness[5];
  };
  struct Vertex {
    Point x[2], v[2], start_x, start_v, sum_v, sum_a;
    double mass;
    int pinned, triangles;
    Spring around[most_triangles];
  };

  SheetOfStructs(const SpringProblem& problem, const Numbering& numbering, const ExecutionSpace&)
      : _vertices("drogue::perf::ladder::vertices", numbering.vertices()),
        _host("drogue::perf::ladder::vertices on the host", numbering.vertices()) {
    for (std::size_t i = 0; i < numbering.vertices(); ++i) {
      Vertex& vertex = _host(i);
      vertex.mass = numbering.parameters.mass[i];
      vertex.pinned = numbering.parameters.pinned[i];
      vertex.triangles = 0;
      for (const VertexTriangle& t : numbering.triangles[i]) {
        Spring& spring = vertex.around[vertex.triangles++];
        spring.a = t.a, spring.b = t.b;
        for (int e = 0; e < 3; ++e) spring.rest[e] = t.rest[e];
        stiffnesses(problem, t, inverse_area(t), spring.stiffness);
      }
    }
  }

  void upload(const ExecutionSpace& space, const sheet::State& state) {
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      _host(i).x[0] = _host(i).start_x = {state.x[i][0], state.x[i][1], state.x[i][2]};
      _host(i).v[0] = _host(i).start_v = {state.v[i][0], state.v[i][1], state.v[i][2]};
    }
    device::copy(space, _vertices, _host);
  }

  [[nodiscard]] std::vector<fabric::Vector> positions(const ExecutionSpace& space) const {
    device::copy(space, _host, _vertices);
    space.fence("drogue::perf::ladder: vertices are on the host");
    std::vector<fabric::Vector> x;
    for (std::size_t i = 0; i < _host.size(); ++i)
      x.push_back({_host(i).x[0].x, _host(i).x[0].y, _host(i).x[0].z});
    return x;
  }

  KOKKOS_FUNCTION Point force(int buffer, int i) const {
    const Vertex& vertex = _vertices(i);
    Point sum{0.0, 0.0, 0.0};
    for (int t = 0; t < vertex.triangles; ++t) {
      const Spring& s = vertex.around[t];
      const TriangleEdges<double> edges(vertex.x[buffer], _vertices(s.a).x[buffer], _vertices(s.b).x[buffer],
                                        s.rest);
      const Tensions tension = stored_tensions(edges.change, s.stiffness);
      sum = edges.add_force(sum, tension);
    }
    return sum;
  }
  KOKKOS_FUNCTION Point v(int buffer, int i) const { return _vertices(i).v[buffer]; }
  KOKKOS_FUNCTION Point start_x(int i) const { return _vertices(i).start_x; }
  KOKKOS_FUNCTION Point start_v(int i) const { return _vertices(i).start_v; }
  KOKKOS_FUNCTION Point sum_v(int i) const { return _vertices(i).sum_v; }
  KOKKOS_FUNCTION Point sum_a(int i) const { return _vertices(i).sum_a; }
  KOKKOS_FUNCTION double mass(int i) const { return _vertices(i).mass; }
  KOKKOS_FUNCTION bool is_pinned(int i) const { return _vertices(i).pinned != 0; }
  KOKKOS_FUNCTION void set(int buffer, int i, const Point& x, const Point& v) const {
    _vertices(i).x[buffer] = x, _vertices(i).v[buffer] = v;
  }
  KOKKOS_FUNCTION void set_start(int i, const Point& x, const Point& v) const {
    _vertices(i).start_x = x, _vertices(i).start_v = v;
  }
  KOKKOS_FUNCTION void set_sums(int i, const Point& v, const Point& a) const {
    _vertices(i).sum_v = v, _vertices(i).sum_a = a;
  }

 private:
  Kokkos::View<Vertex*, typename ExecutionSpace::memory_space> _vertices;
  Kokkos::View<Vertex*, Kokkos::HostSpace> _host;
};

/// Rung 1. An array of structures with stored neighbours and stiffnesses, as an object-oriented code on a CPU
/// keeps its vertices: a thread per vertex walks them.
///
/// Prediction: 8 stored numbers and two indices per triangle around each vertex. The model counts bytes that
/// are used; the lines of memory in which they lie hold as many that are not.
template <class ExecutionSpace>
Rung structs_rung(const Shared<SpringProblem>& problem) {
  return make_rung<SpringRung<ExecutionSpace, SheetOfStructs<ExecutionSpace>>>(
      RungText{"structs", "An array of structures with stored neighbours and stiffnesses.",
               "On a host 2.17 to 2.43 times the prediction: a core waits for each load of a scattered "
               "neighbour, which the model takes for free. On an H100 64.0 us where the model has 45.2 "
               "us: threads fetch lines of memory of which they use a part (docs/lessons/tables.md)."},
      spring_work(*problem, 1, 8, stored_operations), problem, &SpringProblem::scattered);
}

}  // namespace drogue::perf::ladder
