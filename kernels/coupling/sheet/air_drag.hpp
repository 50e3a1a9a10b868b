#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/rank_sum.hpp"
#include "kernels/coupling/sheet/drag_relaxation.hpp"
#include "kernels/coupling/sheet/sheet_parameters.hpp"
#include "kernels/coupling/spread.hpp"
#include "kernels/device/backend_list.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/stepping/state_list.hpp"

namespace drogue::coupling {

/// Straight lines, then bodies at a vertex, each with points at which the air acts on it.
template <class ExecutionSpace>
struct DragElements {
  template <class T>
  using List = fabric::ListView<ExecutionSpace, T>;

  fabric::TableView<ExecutionSpace, int, 2> ends;  ///< vertices; both are one of a body
  List<int> first;                                 ///< points of each, and their number after the last
  List<int> of_point;                              ///< element of each point
  List<double> across, along;  ///< coefficient times diameter, m; of a body times area, m^2
  int lines = 0;               ///< their number: they come first

  /// Position of an end, m, after a time, s, at the present velocity.
  KOKKOS_FUNCTION spatial::Point end(const fabric::State<ExecutionSpace>& cloth, int element, int k,
                                     double time) const {
    const int i = ends(element, k);
    return spatial::load_vector(cloth.positions, i) + time * spatial::load_vector(cloth.velocities, i);
  }
  /// Place of a point on its element, from 0 at one end to 1 at the other: parts of equal length have one
  /// each.
  KOKKOS_FUNCTION double place(int element, int point) const {
    return (point - first(element) + 0.5) / (first(element + 1) - first(element));
  }
};

/// Value at a place on an element, from those at its ends.
KOKKOS_INLINE_FUNCTION spatial::Point between(double place, const spatial::Point& one,
                                              const spatial::Point& other) {
  return (1.0 - place) * one + place * other;
}

/// Freezes the points in the middle of a step of the flow, as the vertices of sheets.
template <class ExecutionSpace>
struct PlaceDragPointsFunctor {
  using Vectors = typename DragRelaxation<ExecutionSpace>::Vectors;

  DragElements<ExecutionSpace> elements;
  fabric::State<ExecutionSpace> cloth;
  double time;  ///< s, from the beginning of the step
  Vectors points;

  KOKKOS_FUNCTION void operator()(const int point) const {
    const int element = elements.of_point(point);
    spatial::store_vector(points, point,
                          between(elements.place(element, point), elements.end(cloth, element, 0, time),
                                  elements.end(cloth, element, 1, time)));
  }
};

/// Drag at the velocities at the beginning of a step, at all points of an element and the share of its ends.
template <class ExecutionSpace>
struct DragOfElementsFunctor {
  using Vectors = typename DragRelaxation<ExecutionSpace>::Vectors;
  using Rates = typename DragRelaxation<ExecutionSpace>::Rates;

  DragElements<ExecutionSpace> elements;
  fabric::State<ExecutionSpace> cloth;
  double time;  ///< s, from the beginning of the step to its middle
  Vectors air;  ///< velocity at the points, m/s
  double density;
  Vectors force;  ///< of the air at each point, N
  Rates rate;
  Vectors end_force;  ///< of end k of element e in row 2 e + k
  Rates end_rate;

  KOKKOS_FUNCTION void operator()(const int element) const {
    using spatial::load_vector, spatial::Point;
    const int a = elements.ends(element, 0), b = elements.ends(element, 1), first = elements.first(element),
              end = elements.first(element + 1);
    const Point one = load_vector(cloth.velocities, a), other = load_vector(cloth.velocities, b);
    const Point chord = elements.end(cloth, element, 1, time) - elements.end(cloth, element, 0, time);
    const double size = length(chord), part = a == b ? 1.0 : size / (end - first);  // a body has no length
    const Point direction = size > 0.0 ? (1.0 / size) * chord : chord;
    const double half = 0.5 * density * part;
    Point sum[2] = {};
    DragRate rates[2];
    for (int point = first; point < end; ++point) {
      const double at = elements.place(element, point);
      const Point w = between(at, one, other) - load_vector(air, point);
      const double slip = dot(w, direction);
      const DragRate of_point = drag_rate(half * elements.across(element) * length(w - slip * direction),
                                          half * elements.along(element) * Kokkos::fabs(slip), direction);
      const Point drag = -1.0 * product(of_point, w);
      spatial::store_vector(force, point, drag);
      rate(point) = of_point;
      sum[0] = sum[0] + (1.0 - at) * drag, sum[1] = sum[1] + at * drag;
      rates[0] = rates[0] + (1.0 - at) * of_point, rates[1] = rates[1] + at * of_point;
    }
    for (int k = 0; k < 2; ++k) {
      spatial::store_vector(end_force, 2 * element + k, sum[k]);
      end_rate(2 * element + k) = rates[k];
    }
  }
};

/// Ends of elements at each vertex that has some.
template <class ExecutionSpace>
struct DragVertices {
  fabric::ListView<ExecutionSpace, int> vertex, first, end;
};

/// Drag on a vertex, linear in its velocity.
template <class ExecutionSpace>
struct DragOfVerticesFunctor {
  using Vectors = typename DragRelaxation<ExecutionSpace>::Vectors;
  using Rates = typename DragRelaxation<ExecutionSpace>::Rates;

  DragVertices<ExecutionSpace> vertices;
  fabric::PointsView<ExecutionSpace> velocities;
  Vectors end_force;
  Rates end_rate;
  DragRelaxation<ExecutionSpace> relaxation;
  Vectors before;  ///< velocity of each vertex at the beginning of the step, m/s

  KOKKOS_FUNCTION void operator()(const int k) const {
    const int i = vertices.vertex(k);
    const spatial::Point velocity = spatial::load_vector(velocities, i);
    spatial::Point force{0.0, 0.0, 0.0};
    DragRate rate;
    for (int n = vertices.first(k); n < vertices.first(k + 1); ++n) {
      force = force + spatial::load_vector(end_force, vertices.end(n));
      rate = rate + end_rate(vertices.end(n));
    }
    spatial::store_vector(before, i, velocity);
    spatial::store_vector(relaxation.drive, i, force + product(rate, velocity));
    relaxation.rate(i) = rate;
    spatial::store_vector(relaxation.path, i, spatial::Point{0.0, 0.0, 0.0});
  }
};

/// Mean force of the air at the points of an element in a step, whose share of its ends is their impulse, and
/// its sum. Lines react on the air.
template <class ExecutionSpace>
struct DragReactionFunctor {
  using Vectors = typename DragRelaxation<ExecutionSpace>::Vectors;
  using Rates = typename DragRelaxation<ExecutionSpace>::Rates;

  DragElements<ExecutionSpace> elements;
  DragRelaxation<ExecutionSpace> relaxation;
  Vectors before, force;
  Rates rate;
  double inverse_dt;  ///< 1/s
  Vectors on_air;     ///< of each point, N
  Vectors sum;        ///< force of the air on each element, N

  /// What a vertex has lost of its velocity in the mean over the step, m/s.
  KOKKOS_FUNCTION spatial::Point loss(int vertex) const {
    return spatial::load_vector(before, vertex) - inverse_dt * spatial::load_vector(relaxation.path, vertex);
  }
  KOKKOS_FUNCTION void operator()(const int element) const {
    using spatial::Point;
    const Point one = loss(elements.ends(element, 0)), other = loss(elements.ends(element, 1));
    Point total{0.0, 0.0, 0.0};
    for (int point = elements.first(element); point < elements.first(element + 1); ++point) {
      const Point mean = spatial::load_vector(force, point) +
                         product(rate(point), between(elements.place(element, point), one, other));
      spatial::store_vector(on_air, point, element < elements.lines ? -1.0 * mean : Point{0.0, 0.0, 0.0});
      total = total + mean;
    }
    spatial::store_vector(sum, element, total);
  }
};

/// Drag of lines and of bodies at vertices (`Parameters::line_drag`, `vertex_drag`). Without any, functions
/// do nothing and there are no Views.
///
/// Points at most a cell apart along each line have the velocity of the air there. The drag of a step of the
/// flow acts on the ends in proportion to their distance from each point, as on a rod between two supports.
/// The speeds of its coefficients are those at the beginning of the step, the velocities that they multiply
/// those of the ends during it, so that steps of any length are stable for vertices of any mass and no force
/// turns against the air. Points spread the reaction with the weights of the interpolation.
///
/// A step of the flow is `begin_step`, steps of the cloth with `relaxation`, `spread_forces`. Functions are
/// asynchronous unless stated otherwise; `begin_step` is collective and blocks on several ranks.
template <class ExecutionSpace>
class AirDrag {
 public:
  using Relaxation = DragRelaxation<ExecutionSpace>;
  using Vectors = typename Relaxation::Vectors;
  using Rates = typename Relaxation::Rates;
  using Cloth = fabric::State<ExecutionSpace>;
  using Faces = FaceViews<flow::FaceView<ExecutionSpace>>;

  /// Of lines and bodies of a cloth that exchanges forces as `sheet`, in air with a density in kg/m^3.
  /// `own_faces`: those of this rank. Blocks. Throws std::invalid_argument for parameters out of range.
  AirDrag(const ExecutionSpace& space, const StaggeredGrid& grid, const fabric::Mesh& mesh,
          const std::vector<LineDrag>& of_lines, const std::vector<VertexDrag>& of_vertices,
          const SheetParameters& sheet, double density,
          const linear::DeviceCommunicator<ExecutionSpace>& communicator,
          const std::optional<FaceWindow>& own_faces)
      : _density(density), _of_line(of_lines) {
    check_parameters(mesh, of_lines, of_vertices, sheet);
    if (of_lines.empty() && of_vertices.empty()) return;
    const double h = std::ranges::min(grid.spacing);
    std::array<std::vector<int>, 2> ends;
    std::vector<int> first = {0}, of_point;
    std::vector<double> across, along;
    const auto add = [&](int a, int b, double coefficient, double of_length, int points) {
      of_point.insert(of_point.end(), static_cast<std::size_t>(points), static_cast<int>(across.size()));
      ends[0].push_back(a), ends[1].push_back(b);
      across.push_back(coefficient), along.push_back(of_length);
      first.push_back(static_cast<int>(of_point.size()));
    };
    for (const LineDrag& drag : of_lines) {
      const auto line = static_cast<std::size_t>(drag.line);
      const auto [a, b] = mesh.lines[line];
      add(a, b, drag.across, drag.along, static_cast<int>(std::ceil(mesh::rest_length(mesh, line) / h)));
    }
    for (const VertexDrag& drag : of_vertices) add(drag.vertex, drag.vertex, drag.area, 0.0, 1);
    const auto points = of_point.size(), elements = across.size(), rows = mesh.rest.size();
    list_vertices(space, ends, rows);
    _elements = {.ends = fabric::table_view(space, "drogue::coupling::drag_ends", ends),
                 .first = fabric::list_view(space, "drogue::coupling::drag_first", first),
                 .of_point = fabric::list_view(space, "drogue::coupling::drag_of_point", of_point),
                 .across = fabric::list_view(space, "drogue::coupling::drag_across", across),
                 .along = fabric::list_view(space, "drogue::coupling::drag_along", along),
                 .lines = static_cast<int>(of_lines.size())};
    _transfer.emplace(space, grid, sheet.delta, static_cast<int>(points), own_faces);
    _rank_sum.emplace(communicator, points, 1);
    _relaxation = {
        .drive = vectors("drive", rows), .rate = rates("rate", rows), .path = vectors("path", rows)};
    _before = vectors("before", rows);
    _air = vectors("air", points), _force = vectors("force", points), _on_air = vectors("on_air", points);
    _rate = rates("point_rate", points);
    _end_force = vectors("end_force", 2 * elements), _end_rate = rates("end_rate", 2 * elements);
    _sum = vectors("sum", elements);
  }

  [[nodiscard]] bool empty() const { return !_transfer.has_value(); }
  /// For `AirRelaxation`. Does not throw.
  [[nodiscard]] const Relaxation& relaxation() const { return _relaxation; }

  /// Adds the arrays that a roll-back needs, and "drag": the force of the air on each line of `line_drag`,
  /// then on each body of `vertex_drag`, in the last step of the flow, N.
  void add_state(stepping::StateList<ExecutionSpace>& state) const {
    if (empty()) return;
    state.add("drag", "N", _sum, elements(), {.restarted = false});
    state.add("drag_on_air", "N", _on_air, _transfer->points, {.restarted = false});
    state.add("drag_place", "m", _transfer->positions, _transfer->points, {.restarted = false});
  }

  /// Sets the forces to zero, as before the first step.
  void forget_force(const ExecutionSpace& space) const {
    if (empty()) return;
    for (const Vectors& force : {_on_air, _sum}) Kokkos::deep_copy(space, force, 0.0);
  }

  /// Gives lines without stiffness, which are cut, no drag. `of_lines`: E A of every line of the mesh, N.
  /// Blocks.
  void set_line_stiffness(const ExecutionSpace& space, std::span<const double> of_lines) const;

  /// Enqueues the drag at the velocities at the beginning of a step of dt, s. `velocity`: of the flow, m/s.
  void begin_step(const ExecutionSpace& space, const Cloth& cloth, const Faces& velocity, double dt) const;

  /// Enqueues the spreading of the reaction in the step: adds it to `force_density`, N/m^3.
  void spread_forces(const ExecutionSpace& space, const Faces& force_density, double dt) const;

  /// Enqueues the spreading of the last forces at their places, as a roll-back needs it, and zeros where they
  /// were spread.
  void spread_again(const ExecutionSpace& space, const Faces& force_density) const;
  void clear_forces(const ExecutionSpace& space, const Faces& force_density) const;

 private:
  static void check_parameters(const fabric::Mesh& mesh, const std::vector<LineDrag>& of_lines,
                               const std::vector<VertexDrag>& of_vertices, const SheetParameters& sheet) {
    const auto require = [](bool holds, const char* rule) {
      if (!holds) throw std::invalid_argument(std::string("air drag: ") + rule);
    };
    const auto is_valid = [](double value) { return value >= 0.0 && value <= 1e100; };
    require((of_lines.empty() && of_vertices.empty()) || sheet.method != CouplingMethod::sharp,
            "sharp sheets have no lines");
    for (const LineDrag& drag : of_lines) {
      require(drag.line >= 0 && static_cast<std::size_t>(drag.line) < mesh.lines.size(),
              "a line must be one of the mesh");
      require(is_valid(drag.across) && is_valid(drag.along),
              "coefficients times diameter must be finite and not negative");
    }
    for (const VertexDrag& drag : of_vertices) {
      require(drag.vertex >= 0 && static_cast<std::size_t>(drag.vertex) < mesh.rest.size(),
              "a vertex must be one of the mesh");
      require(is_valid(drag.area), "the coefficient times area must be finite and not negative");
    }
  }

  static Vectors vectors(const std::string& name, std::size_t rows) {
    return Vectors("drogue::coupling::drag_" + name, rows);
  }
  static Rates rates(const std::string& name, std::size_t rows) {
    return Rates("drogue::coupling::drag_" + name, rows);
  }
  [[nodiscard]] int elements() const { return static_cast<int>(_sum.extent(0)); }

  /// Finds the ends of elements at each vertex.
  void list_vertices(const ExecutionSpace& space, const std::array<std::vector<int>, 2>& ends,
                     std::size_t rows) {
    std::vector<std::vector<int>> at(rows);
    for (std::size_t element = 0; element < ends[0].size(); ++element)
      for (std::size_t k = 0; k < 2; ++k)
        at[static_cast<std::size_t>(ends[k][element])].push_back(static_cast<int>(2 * element + k));
    std::vector<int> vertex, first = {0}, of_vertices;
    for (std::size_t i = 0; i < rows; ++i) {
      if (at[i].empty()) continue;
      vertex.push_back(static_cast<int>(i));
      of_vertices.insert(of_vertices.end(), at[i].begin(), at[i].end());
      first.push_back(static_cast<int>(of_vertices.size()));
    }
    _vertices = {.vertex = fabric::list_view(space, "drogue::coupling::drag_vertex", vertex),
                 .first = fabric::list_view(space, "drogue::coupling::drag_first_end", first),
                 .end = fabric::list_view(space, "drogue::coupling::drag_end", of_vertices)};
  }

  double _density;  ///< kg/m^3
  std::vector<LineDrag> _of_line;
  DragElements<ExecutionSpace> _elements;
  DragVertices<ExecutionSpace> _vertices;
  std::optional<GridTransfer<ExecutionSpace>> _transfer;  ///< of the points; empty without drag
  std::optional<RankSum<ExecutionSpace>> _rank_sum;
  Relaxation _relaxation;
  Vectors _before;                ///< of vertices
  Vectors _air, _force, _on_air;  ///< of points
  Rates _rate;
  Vectors _end_force, _sum;  ///< of the ends of elements, and of these
  Rates _end_rate;
};

template <class ExecutionSpace>
void AirDrag<ExecutionSpace>::set_line_stiffness(const ExecutionSpace& space,
                                                 std::span<const double> of_lines) const {
  if (empty()) return;
  const auto across = Kokkos::create_mirror_view(_elements.across),
             along = Kokkos::create_mirror_view(_elements.along);
  device::copy(space, across, _elements.across);
  device::copy(space, along, _elements.along);
  space.fence("drogue::coupling::set_line_stiffness: read");
  for (std::size_t k = 0; k < _of_line.size(); ++k) {
    const bool is_whole = of_lines[static_cast<std::size_t>(_of_line[k].line)] > 0.0;
    across(k) = is_whole ? _of_line[k].across : 0.0;
    along(k) = is_whole ? _of_line[k].along : 0.0;
  }
  device::copy(space, _elements.across, across);
  device::copy(space, _elements.along, along);
  space.fence("drogue::coupling::set_line_stiffness");
}

template <class ExecutionSpace>
void AirDrag<ExecutionSpace>::begin_step(const ExecutionSpace& space, const Cloth& cloth,
                                         const Faces& velocity, double dt) const {
  if (empty()) return;
  // Points between vertices within the grid, whose places sheets check, are within it too.
  device::launch_each(
      space, "drogue::coupling::place_drag_points", _transfer->points,
      PlaceDragPointsFunctor<ExecutionSpace>{_elements, cloth, 0.5 * dt, _transfer->positions});
  interpolate(space, *_transfer, velocity, _air);
  (*_rank_sum)(space, {_air});
  device::launch_each(space, "drogue::coupling::drag_of_elements", elements(),
                      DragOfElementsFunctor<ExecutionSpace>{.elements = _elements,
                                                            .cloth = cloth,
                                                            .time = 0.5 * dt,
                                                            .air = _air,
                                                            .density = _density,
                                                            .force = _force,
                                                            .rate = _rate,
                                                            .end_force = _end_force,
                                                            .end_rate = _end_rate});
  device::launch_each(space, "drogue::coupling::drag_of_vertices",
                      static_cast<int>(_vertices.vertex.extent(0)),
                      DragOfVerticesFunctor<ExecutionSpace>{_vertices, cloth.velocities, _end_force,
                                                            _end_rate, _relaxation, _before});
}

template <class ExecutionSpace>
void AirDrag<ExecutionSpace>::spread_forces(const ExecutionSpace& space, const Faces& force_density,
                                            double dt) const {
  if (empty()) return;
  device::launch_each(space, "drogue::coupling::drag_reaction", elements(),
                      DragReactionFunctor<ExecutionSpace>{.elements = _elements,
                                                          .relaxation = _relaxation,
                                                          .before = _before,
                                                          .force = _force,
                                                          .rate = _rate,
                                                          .inverse_dt = 1.0 / dt,
                                                          .on_air = _on_air,
                                                          .sum = _sum});
  spread_again(space, force_density);
}

template <class ExecutionSpace>
void AirDrag<ExecutionSpace>::spread_again(const ExecutionSpace& space, const Faces& force_density) const {
  if (!empty()) spread(space, *_transfer, _on_air, force_density);
}

template <class ExecutionSpace>
void AirDrag<ExecutionSpace>::clear_forces(const ExecutionSpace& space, const Faces& force_density) const {
  if (!empty()) clear_spread(space, *_transfer, force_density);
}

DROGUE_EXTERN_INSTANCES(class AirDrag)

}  // namespace drogue::coupling
