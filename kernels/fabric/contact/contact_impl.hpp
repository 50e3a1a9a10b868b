#pragma once

#include <algorithm>
#include <bit>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/fabric/contact/broad_phase.hpp"
#include "kernels/fabric/contact/contact.hpp"
#include "kernels/fabric/contact/features.hpp"
#include "kernels/fabric/contact/impulses.hpp"
#include "kernels/fabric/contact/persistent_resolution.hpp"
#include "kernels/fabric/contact/rigid_zones.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Contact on one backend. Owns the memory of `ContactViews` and enqueues the kernels.
template <class ExecutionSpace>
class ContactImpl final : public ContactHandler<ExecutionSpace> {
 public:
  using Points = PointsView<ExecutionSpace>;

  ContactImpl(const Mesh& mesh, const Contact& contact, Driver driver, double dt,
              const ContactInputs<ExecutionSpace>& inputs);
  ContactImpl(const ContactImpl&) = delete;  // captured graphs refer to this object
  ContactImpl& operator=(const ContactImpl&) = delete;

  void begin_step(const Points& x, const Points& v) override { graphs(x, v).begin.launch(); }
  void end_step(const Points& x, const Points& v) override { graphs(x, v).end.launch(); }
  void set_dt(double dt) override;
  void begin_interval(const Points& x, double duration) override {
    _dt = duration;
    launch("drogue::fabric::start_interval", _views.vertices,
           StartIntervalFunctor<ExecutionSpace>{_views, x, duration});
  }
  void end_interval(const Points& x, const Points& v) override {
    if constexpr (Grid::available)
      if (_grid) return _grid->template launch<Resolution::largest_team, 1>(Resolution{{_views}, x, v});
    graphs(x, v).end.launch();
  }
  void reset() override;
  [[nodiscard]] const ListView<ExecutionSpace, ContactWork>& work() const override { return _work; }
  void set_line_stiffness(std::span<const double> of_lines) override;
  [[nodiscard]] FailureReason reason(std::int64_t step) const override;
  /// Data of the kernels.
  [[nodiscard]] const ContactViews<ExecutionSpace>& views() const { return _views; }

 private:
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;
  using Grid = device::PersistentKernel<ExecutionSpace>;
  using Resolution = PersistentResolutionFunctor<ExecutionSpace>;

  /// Kernels before and after a step, or after an interval, for one pair of addresses of positions and
  /// velocities.
  struct StepGraphs {
    StepGraphs(ContactImpl& contact, const Points3& at, const Points3& velocity)
        : x(at),
          v(velocity),
          begin(contact._instance,
                [&contact, at, velocity](const auto&) { contact.enqueue_begin(at, velocity); }),
          end(contact._instance,
              [&contact, at, velocity](const auto&) { contact.enqueue_end(at, velocity); }) {}
    Points3 x, v;
    device::CapturedGraph<ExecutionSpace> begin, end;
  };

  /// Allocates the memory of an unmanaged View.
  template <class Unmanaged, class... Sizes>
  void allocate(Unmanaged& to, const char* label, Sizes... sizes);
  template <class Functor>
  void launch(const char* label, int count, const Functor& functor) const;
  StepGraphs& graphs(const Points& x, const Points& v);
  void forget_lists() const;
  void enqueue_begin(const Points3& x, const Points3& v) const;
  void enqueue_end(const Points3& x, const Points3& v) const;
  void enqueue_impulses(const Points3& x, const Points3& v) const;
  void enqueue_zones(const Points3& x, const Points3& v) const;
  [[nodiscard]] int parts() const { return _views.vertices + _views.edges + _views.triangles; }

  const device::Instance<ExecutionSpace>& _instance;
  std::vector<std::shared_ptr<void>> _owned;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _inverse_mass;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> _fixed_dofs;
  ListView<ExecutionSpace, ContactWork> _work;
  double _dt;  ///< s, as last set
  ContactViews<ExecutionSpace> _views;
  std::vector<int> _edge_of_line;  ///< `edges_of_lines`
  std::list<StepGraphs> _graphs;
  std::optional<Grid> _grid;  ///< resolves contact of intervals; empty with other drivers
};

/// Sets dt, s, of the following steps. Launched for one index.
template <class ExecutionSpace>
struct SetStepFunctor {
  ContactViews<ExecutionSpace> views;
  double dt;

  KOKKOS_FUNCTION void operator()(const int) const { views.progress(0).dt = dt; }
};

/// Clears the velocity changes of the last step, which belong to replaced velocities.
template <class ExecutionSpace>
struct ResetKickFunctor {
  ListView<ExecutionSpace, ContactWork> work;

  KOKKOS_FUNCTION void operator()(const int i) const {
    work(i) = {.normal = work(i).normal, .friction = work(i).friction};
  }
};

template <class ExecutionSpace>
template <class Unmanaged, class... Sizes>
void ContactImpl<ExecutionSpace>::allocate(Unmanaged& to, const char* label, Sizes... sizes) {
  using Owned = Kokkos::View<typename Unmanaged::data_type, typename Unmanaged::array_layout,
                             typename Unmanaged::memory_space>;
  const auto owned =
      std::make_shared<Owned>(std::string("drogue::fabric::") + label, static_cast<std::size_t>(sizes)...);
  _owned.push_back(owned);
  to = *owned;
}

template <class ExecutionSpace>
ContactImpl<ExecutionSpace>::ContactImpl(const Mesh& mesh, const Contact& contact, Driver driver, double dt,
                                         const ContactInputs<ExecutionSpace>& inputs)
    : _instance(inputs.instance),
      _inverse_mass(inputs.inverse_mass),
      _fixed_dofs(inputs.fixed_dofs),
      _dt(dt) {
  const CollisionEdges edges = collision_edges(mesh);
  const auto n = mesh.rest.size(), faces = mesh.triangles.size(), sides = edges.ends.size();
  auto& t = _views;
  t.vertices = static_cast<int>(n), t.triangles = static_cast<int>(faces), t.edges = static_cast<int>(sides);
  t.first_line = edges.first_line;
  t.thickness = contact.thickness, t.self_friction = contact.friction, t.self = contact.self;
  t.widest_skin = std::max(contact.thickness, 0.5 * edges.mean_length);
  t.by_interval = contact.interval > 1;
  t.inverse_mass = _inverse_mass, t.fixed_dofs = _fixed_dofs, t.monitor = inputs.monitor;
  allocate(t.bodies, "bodies", contact.bodies.size());
  allocate(t.triangle, "contact_triangles", faces);
  allocate(t.edge, "collision_edges", sides);
  const std::vector<int> long_edges = long_lines(mesh, edges);
  allocate(t.long_edge, "long_edges", long_edges.size());
  allocate(t.is_long, "edge_is_long", sides);
  allocate(t.is_cut, "edge_is_cut", sides);
  _edge_of_line = edges_of_lines(mesh, edges);
  allocate(t.owned, "owned_features", faces);
  const auto bodies = Kokkos::create_mirror_view(t.bodies);
  const auto triangle = Kokkos::create_mirror_view(t.triangle);
  const auto owned = Kokkos::create_mirror_view(t.owned);
  const std::vector<int> owned_bits = owned_features(mesh);
  for (std::size_t k = 0; k < faces; ++k) owned(k) = owned_bits[k];
  const auto edge = Kokkos::create_mirror_view(t.edge);
  for (std::size_t k = 0; k < contact.bodies.size(); ++k) bodies(k) = obstacle(contact.bodies[k]);
  for (std::size_t k = 0; k < faces; ++k)
    for (std::size_t corner = 0; corner < 3; ++corner) triangle(k, corner) = mesh.triangles[k][corner];
  for (std::size_t k = 0; k < sides; ++k)
    for (std::size_t end = 0; end < 2; ++end) edge(k, end) = edges.ends[k][end];
  const auto long_edge = Kokkos::create_mirror_view(t.long_edge);
  const auto is_long = Kokkos::create_mirror_view(t.is_long);
  Kokkos::deep_copy(is_long, std::uint8_t{0});
  for (std::size_t k = 0; k < long_edges.size(); ++k)
    long_edge(k) = long_edges[k], is_long(static_cast<std::size_t>(long_edges[k])) = 1;
  device::copy(_instance.space(), t.long_edge, long_edge);
  device::copy(_instance.space(), t.is_long, is_long);
  device::copy(_instance.space(), t.bodies, bodies);
  device::copy(_instance.space(), t.triangle, triangle);
  device::copy(_instance.space(), t.edge, edge);
  device::copy(_instance.space(), t.owned, owned);
  _instance.space().fence("drogue::fabric::contact_parts");
  allocate(t.start_x, "start_positions", n), allocate(t.start_v, "start_velocities", n);
  allocate(t.end_x, "end_positions", n), allocate(t.end_v, "end_velocities", n);
  allocate(t.listed_x, "listed_positions", n);
  const std::size_t layers = t.self ? 1 : 0, buckets = std::bit_ceil(std::max<std::size_t>(sides, 64));
  allocate(t.triangle_heads, "first_triangle", layers * buckets),
      allocate(t.edge_heads, "first_edge", layers * buckets);
  allocate(t.triangle_sphere, "triangle_spheres", layers * faces);
  allocate(t.edge_sphere, "edge_spheres", layers * sides);
  allocate(t.near_triangles, "near_triangles", layers * n),
      allocate(t.near_edges, "near_edges", layers * sides);
  const int room =
      t.by_interval || sides <= most_edges_of_long_lists ? max_neighbours : max_neighbours_of_large_meshes;
  allocate(t.near_triangle, "near_triangle", layers * n, room),
      allocate(t.near_edge, "near_edge", layers * sides, room);
  allocate(t.constraint, "constraints", 1024 + (t.by_interval ? 16 : 8) * n);
  allocate(t.constraints, "constraint_counts", n), allocate(t.vertex_constraint, "vertex_constraints", n);
  allocate(t.impulse_sum, "impulse_sums", n);
  allocate(t.zone, "zone", n), allocate(t.label, "label_zones", n), allocate(t.zone_end, "zone_end", n);
  allocate(t.stuck, "stuck", n), allocate(t.motion, "zone_motion", n);
  allocate(t.progress, "contact_progress", 1);
  _work = ListView<ExecutionSpace, ContactWork>("drogue::fabric::contact_work", n);
  t.work = _work;
  if (!mesh.line_stiffness.empty()) set_line_stiffness(mesh.line_stiffness);
  reset();
  if constexpr (Grid::available) {
    const int teams = Grid::most_teams(_instance);
    if (t.by_interval && teams > 0 && (driver == Driver::automatic || driver == Driver::persistent))
      _grid.emplace(_instance, teams, contact.block > 0 ? contact.block : Resolution::largest_team, 0, 0);
  }
}

template <class ExecutionSpace>
template <class Functor>
void ContactImpl<ExecutionSpace>::launch(const char* label, int count, const Functor& functor) const {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace,
                                           typename PointsView<ExecutionSpace>::memory_space>::accessible);
  device::launch_each(_instance.space(), label, count, functor);
}

template <class ExecutionSpace>
auto ContactImpl<ExecutionSpace>::graphs(const Points& x, const Points& v) -> StepGraphs& {
  for (StepGraphs& known : _graphs)
    if (known.x.data() == x.data() && known.v.data() == v.data()) return known;
  return _graphs.emplace_back(*this, x, v);
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::enqueue_begin(const Points3& x, const Points3& v) const {
  using Space = ExecutionSpace;
  launch("drogue::fabric::motion_bounds", _views.vertices, MotionBoundsFunctor<Space>{_views, x, v});
  enqueue_impulses(x, v);
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::enqueue_end(const Points3& x, const Points3& v) const {
  using Space = ExecutionSpace;
  if (_views.by_interval) {
    launch("drogue::fabric::mean_motion", _views.vertices, MeanMotionFunctor<Space>{_views, x});
    enqueue_impulses(x, v);
  }
  enqueue_zones(x, v);
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::enqueue_impulses(const Points3& x, const Points3& v) const {
  using Space = ExecutionSpace;
  const int n = _views.vertices;
  launch("drogue::fabric::rebuild_decision", 1, RebuildDecisionFunctor<Space>{_views});
  if (_views.self) {
    const int buckets = static_cast<int>(_views.triangle_heads.extent(0));
    launch("drogue::fabric::clear_grid", std::max({buckets, n, _views.edges}),
           ClearGridFunctor<Space>{_views});
    launch("drogue::fabric::fill_grid", std::max(_views.triangles, _views.edges),
           FillGridFunctor<Space>{_views});
    launch("drogue::fabric::neighbour_lists", n + _views.edges, NeighbourListFunctor<Space>{_views, false});
    launch("drogue::fabric::narrow_skin", 1, NarrowSkinFunctor<Space>{_views});
    launch("drogue::fabric::neighbour_lists", n + _views.edges, NeighbourListFunctor<Space>{_views, true});
  }
  launch("drogue::fabric::detect_constraints", parts(), DetectConstraintsFunctor<Space>{_views});
  const int items = device::is_host<Space> ? _instance.space().concurrency()
                                           : std::min(32768, static_cast<int>(_views.constraint.extent(0)));
  for (int round = 0; round < impulse_rounds; ++round) {
    launch("drogue::fabric::solve_impulses", items, SolveImpulsesFunctor<Space>{_views, items, round});
    launch("drogue::fabric::apply_impulses", n, ApplyImpulsesFunctor<Space>{_views, x, v, round});
  }
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::enqueue_zones(const Points3& x, const Points3& v) const {
  using Space = ExecutionSpace;
  const int n = _views.vertices;
  launch("drogue::fabric::continuous_detection", parts(), CcdFunctor<Space>{_views, x, 0});
  for (int round = 0; round < zone_rounds; ++round) {
    launch("drogue::fabric::label_zones", n, LabelZonesFunctor<Space>{_views, round});
    launch("drogue::fabric::zone_motion", n, ZoneMotionFunctor<Space>{_views, x, v, round});
    launch("drogue::fabric::move_zones", n, MoveZonesFunctor<Space>{_views, x, v, round});
    launch("drogue::fabric::continuous_detection", parts(),
           CcdFunctor<Space>{_views, _views.end_x, round + 1});
  }
  launch("drogue::fabric::commit_zones", n, CommitZonesFunctor<Space>{_views, x, v});
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::set_dt(double dt) {
  if (dt == _dt) return;
  _dt = dt;
  launch("drogue::fabric::set_contact_step", 1, SetStepFunctor<ExecutionSpace>{_views, dt});
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::forget_lists() const {
  const auto progress = Kokkos::create_mirror_view(_views.progress);
  progress(0) = ContactStatus{};
  progress(0).skin = -1.0;  // no list is valid
  progress(0).dt = _dt;
  progress(0).reason = stepping::no_failure;
  device::copy(_instance.space(), _views.progress, progress);
  _instance.space().fence("drogue::fabric::forget_lists");
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::reset() {
  forget_lists();
  launch("drogue::fabric::reset_kick", _views.vertices, ResetKickFunctor<ExecutionSpace>{_work});
  _instance.space().fence("drogue::fabric::reset_contact");
}

template <class ExecutionSpace>
void ContactImpl<ExecutionSpace>::set_line_stiffness(std::span<const double> of_lines) {
  const auto is_cut = Kokkos::create_mirror_view(_views.is_cut);
  Kokkos::deep_copy(is_cut, std::uint8_t{0});
  // Where several lines have the same ends, one that is whole remains an obstacle.
  for (const bool cut : {true, false})
    for (std::size_t line = 0; line < of_lines.size(); ++line)
      if (const int edge = _edge_of_line[line]; edge >= 0 && (of_lines[line] == 0.0) == cut)
        is_cut(static_cast<std::size_t>(edge)) = cut ? 1 : 0;
  device::copy(_instance.space(), _views.is_cut, is_cut);
  forget_lists();
  _instance.space().fence("drogue::fabric::set_line_stiffness");
}

template <class ExecutionSpace>
FailureReason ContactImpl<ExecutionSpace>::reason(std::int64_t step) const {
  const auto progress = Kokkos::create_mirror_view(_views.progress);
  device::copy(_instance.space(), progress, _views.progress);
  _instance.space().fence("drogue::fabric::reason");
  const std::uint64_t recorded = progress(0).reason;
  return static_cast<std::int64_t>(recorded >> 4U) == step ? static_cast<FailureReason>(recorded & 15U)
                                                           : FailureReason::not_finite;
}

template <class ExecutionSpace>
std::unique_ptr<ContactHandler<ExecutionSpace>> make_contact(const Mesh& mesh, const Contact& contact,
                                                             Driver driver, double dt,
                                                             const ContactInputs<ExecutionSpace>& inputs) {
  return std::make_unique<ContactImpl<ExecutionSpace>>(mesh, contact, driver, dt, inputs);
}

}  // namespace drogue::fabric
