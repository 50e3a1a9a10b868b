#pragma once

#include <algorithm>
#include <bit>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "kernels/device/captured_graph.hpp"
#include "kernels/fabric/contact_impulse.hpp"
#include "kernels/fabric/contact_parts.hpp"
#include "kernels/fabric/contact_search.hpp"
#include "kernels/fabric/contact_steps.hpp"
#include "kernels/fabric/contact_zone.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Contact on one backend: owns what `ContactTable` lends to kernels, and knows their order.
template <class ExecutionSpace>
class ContactOn final : public ContactSteps<ExecutionSpace> {
 public:
  using Points = PointsView<ExecutionSpace>;

  ContactOn(const Parameters& p, const ContactCloth<ExecutionSpace>& cloth);
  ContactOn(const ContactOn&) = delete;  // recorded steps know where this one lies
  ContactOn& operator=(const ContactOn&) = delete;

  void begin(const Points& x, const Points& v) override { recorded(x, v).begin.launch(); }
  void end(const Points& x, const Points& v) override { recorded(x, v).end.launch(); }
  void set_dt(double dt) override {
    _table.dt = dt;
    _recorded.clear();
  }
  void forget() override;
  void keep() override;
  void go_back() override { device::copy(_instance.space(), _work, _kept_work); }
  [[nodiscard]] FailureReason reason(std::int64_t step) const override;
  void work(std::span<ContactWork> of_vertices) const override;
  void set_work(std::span<const ContactWork> of_vertices) override;

 private:
  using Places = LentTable<ExecutionSpace, double, 3>;

  /// Both sequences of kernels, for places and velocities that lie where they do.
  struct Recorded {
    Recorded(ContactOn& contact, const Places& at, const Places& velocity)
        : x(at),
          v(velocity),
          begin(contact._instance,
                [&contact, at, velocity](const auto&) { contact.enqueue_begin(at, velocity); }),
          end(contact._instance,
              [&contact, at, velocity](const auto&) { contact.enqueue_end(at, velocity); }) {}
    Places x, v;
    device::CapturedGraph<ExecutionSpace> begin, end;
  };

  template <class Lends, class... Sizes>
  void lend(Lends& to, const char* label, Sizes... sizes);
  template <class Functor>
  void launch(const char* label, int count, const Functor& functor) const;
  Recorded& recorded(const Points& x, const Points& v);
  void enqueue_begin(const Places& x, const Places& v) const;
  void enqueue_end(const Places& x, const Places& v) const;
  [[nodiscard]] int parts() const { return _table.vertices + _table.edges + _table.triangles; }

  const device::Instance<ExecutionSpace>& _instance;
  std::vector<std::shared_ptr<void>> _owned;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _inverse_mass;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> _fixed_dofs;
  ListView<ExecutionSpace, ContactWork> _work, _kept_work;
  typename ListView<ExecutionSpace, ContactWork>::HostMirror _work_on_host;
  ContactTable<ExecutionSpace> _table;
  std::list<Recorded> _recorded;
};

/// Puts the work aside unless a state before was lost.
template <class ExecutionSpace>
struct KeepWorkFunctor {
  StepMonitor<ExecutionSpace> monitor;
  ListView<ExecutionSpace, ContactWork> work, kept;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (monitor.lost() == no_failure) kept(i) = work(i);
  }
};

/// Forgets the kicks: of other velocities than those of now.
template <class ExecutionSpace>
struct ForgetKickFunctor {
  ListView<ExecutionSpace, ContactWork> work;

  KOKKOS_FUNCTION void operator()(const int i) const {
    work(i) = {work(i).normal, work(i).friction, 0.0, 0.0, 0.0};
  }
};

template <class ExecutionSpace>
template <class Lends, class... Sizes>
void ContactOn<ExecutionSpace>::lend(Lends& to, const char* label, Sizes... sizes) {
  using Owned =
      Kokkos::View<typename Lends::data_type, typename Lends::array_layout, typename Lends::memory_space>;
  const auto owned =
      std::make_shared<Owned>(std::string("drogue::fabric::") + label, static_cast<std::size_t>(sizes)...);
  _owned.push_back(owned);
  to = *owned;
}

template <class ExecutionSpace>
ContactOn<ExecutionSpace>::ContactOn(const Parameters& p, const ContactCloth<ExecutionSpace>& cloth)
    : _instance(cloth.instance), _inverse_mass(cloth.inverse_mass), _fixed_dofs(cloth.fixed_dofs) {
  const ContactEdges edges = contact_edges(p.mesh);
  const auto n = p.mesh.rest.size(), faces = p.mesh.triangles.size(), sides = edges.ends.size();
  auto& t = _table;
  t.vertices = static_cast<int>(n), t.triangles = static_cast<int>(faces), t.edges = static_cast<int>(sides);
  t.first_line = edges.first_line;
  t.thickness = p.contact.thickness, t.self_friction = p.contact.friction, t.self = p.contact.self;
  t.widest_skin = std::max(p.contact.thickness, 0.5 * edges.mean_length);
  t.dt = p.dt;
  t.inverse_mass = _inverse_mass, t.fixed_dofs = _fixed_dofs, t.monitor = cloth.monitor;
  lend(t.bodies, "bodies", p.contact.bodies.size());
  lend(t.triangle, "contact_triangles", faces);
  lend(t.edge, "contact_edges", sides);
  lend(t.owned, "owned_parts", faces);
  const auto bodies = Kokkos::create_mirror_view(t.bodies);
  const auto triangle = Kokkos::create_mirror_view(t.triangle);
  const auto owned = Kokkos::create_mirror_view(t.owned);
  const std::vector<int> owned_bits = owned_parts(p.mesh);
  for (std::size_t k = 0; k < faces; ++k) owned(k) = owned_bits[k];
  const auto edge = Kokkos::create_mirror_view(t.edge);
  for (std::size_t k = 0; k < p.contact.bodies.size(); ++k) bodies(k) = obstacle(p.contact.bodies[k]);
  for (std::size_t k = 0; k < faces; ++k)
    for (std::size_t corner = 0; corner < 3; ++corner) triangle(k, corner) = p.mesh.triangles[k][corner];
  for (std::size_t k = 0; k < sides; ++k)
    for (std::size_t end = 0; end < 2; ++end) edge(k, end) = edges.ends[k][end];
  device::copy(_instance.space(), t.bodies, bodies);
  device::copy(_instance.space(), t.triangle, triangle);
  device::copy(_instance.space(), t.edge, edge);
  device::copy(_instance.space(), t.owned, owned);
  _instance.space().fence("drogue::fabric::contact_parts");
  lend(t.start_x, "start_positions", n), lend(t.start_v, "start_velocities", n);
  lend(t.end_x, "end_positions", n), lend(t.end_v, "end_velocities", n);
  lend(t.listed_x, "listed_positions", n);
  const std::size_t layers = t.self ? 1 : 0, buckets = std::bit_ceil(std::max<std::size_t>(sides, 64));
  lend(t.first_triangle, "first_triangle", layers * buckets),
      lend(t.first_edge, "first_edge", layers * buckets);
  lend(t.ball_of_triangle, "ball_of_triangle", layers * faces);
  lend(t.ball_of_edge, "ball_of_edge", layers * sides);
  lend(t.near_triangles, "near_triangles", layers * n), lend(t.near_edges, "near_edges", layers * sides);
  lend(t.near_triangle, "near_triangle", layers * n), lend(t.near_edge, "near_edge", layers * sides);
  lend(t.touch, "touch", 1024 + 8 * n);
  lend(t.touches, "touches", n), lend(t.mine, "touches_of_vertex", n);
  lend(t.zone, "zone", n), lend(t.label, "zone_label", n), lend(t.zone_end, "zone_end", n);
  lend(t.stuck, "stuck", n), lend(t.motion, "zone_motion", n);
  lend(t.progress, "contact_progress", 1);
  _work = ListView<ExecutionSpace, ContactWork>("drogue::fabric::contact_work", n);
  _kept_work = ListView<ExecutionSpace, ContactWork>("drogue::fabric::kept_contact_work", n);
  _work_on_host = Kokkos::create_mirror_view(_work);
  t.work = _work;
  forget();
}

template <class ExecutionSpace>
template <class Functor>
void ContactOn<ExecutionSpace>::launch(const char* label, int count, const Functor& functor) const {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace,
                                           typename PointsView<ExecutionSpace>::memory_space>::accessible);
  Kokkos::parallel_for(
      label,
      Kokkos::Experimental::require(Kokkos::RangePolicy<ExecutionSpace>(_instance.space(), 0, count),
                                    Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

template <class ExecutionSpace>
auto ContactOn<ExecutionSpace>::recorded(const Points& x, const Points& v) -> Recorded& {
  for (Recorded& known : _recorded)
    if (known.x.data() == x.data() && known.v.data() == v.data()) return known;
  return _recorded.emplace_back(*this, x, v);
}

template <class ExecutionSpace>
void ContactOn<ExecutionSpace>::enqueue_begin(const Places& x, const Places& v) const {
  using Space = ExecutionSpace;
  const int n = _table.vertices;
  launch("drogue::fabric::contact_measure", n, MeasureFunctor<Space>{_table, x, v});
  launch("drogue::fabric::contact_decide", 1, DecideFunctor<Space>{_table});
  if (_table.self) {
    const int buckets = static_cast<int>(_table.first_triangle.extent(0));
    launch("drogue::fabric::contact_empty", std::max({buckets, n, _table.edges}),
           EmptyFunctor<Space>{_table});
    launch("drogue::fabric::contact_fill", std::max(_table.triangles, _table.edges),
           FillFunctor<Space>{_table});
    launch("drogue::fabric::contact_list", n + _table.edges, ListFunctor<Space>{_table});
  }
  launch("drogue::fabric::contact_touch", parts(), TouchFunctor<Space>{_table});
  const int items = device::is_host<Space> ? _instance.space().concurrency()
                                           : std::min(32768, static_cast<int>(_table.touch.extent(0)));
  for (int round = 0; round < impulse_rounds; ++round) {
    launch("drogue::fabric::contact_push", items, PushFunctor<Space>{_table, items});
    launch("drogue::fabric::contact_gather", n, GatherFunctor<Space>{_table, v, round});
  }
}

template <class ExecutionSpace>
void ContactOn<ExecutionSpace>::enqueue_end(const Places& x, const Places& v) const {
  using Space = ExecutionSpace;
  const int n = _table.vertices;
  launch("drogue::fabric::contact_check", parts(), CheckFunctor<Space>{_table, x, 0});
  for (int round = 0; round < zone_rounds; ++round) {
    launch("drogue::fabric::zone_label", n, LabelFunctor<Space>{_table, round});
    launch("drogue::fabric::zone_motion", n, ZoneFunctor<Space>{_table, x, v, round});
    launch("drogue::fabric::zone_follow", n, FollowFunctor<Space>{_table, x, v, round});
    launch("drogue::fabric::contact_check", parts(), CheckFunctor<Space>{_table, _table.end_x, round + 1});
  }
  launch("drogue::fabric::zone_settle", n, SettleFunctor<Space>{_table, x, v});
}

template <class ExecutionSpace>
void ContactOn<ExecutionSpace>::forget() {
  const auto progress = Kokkos::create_mirror_view(_table.progress);
  progress(0) = ContactProgress{};
  progress(0).skin = -1.0;  // no list holds
  progress(0).reason = no_failure;
  device::copy(_instance.space(), _table.progress, progress);
  launch("drogue::fabric::forget_kick", _table.vertices, ForgetKickFunctor<ExecutionSpace>{_work});
  _instance.space().fence("drogue::fabric::forget");
}

template <class ExecutionSpace>
void ContactOn<ExecutionSpace>::keep() {
  launch("drogue::fabric::keep_contact", _table.vertices,
         KeepWorkFunctor<ExecutionSpace>{_table.monitor, _work, _kept_work});
}

template <class ExecutionSpace>
FailureReason ContactOn<ExecutionSpace>::reason(std::int64_t step) const {
  const auto progress = Kokkos::create_mirror_view(_table.progress);
  device::copy(_instance.space(), progress, _table.progress);
  _instance.space().fence("drogue::fabric::reason");
  const std::uint64_t told = progress(0).reason;
  return static_cast<std::int64_t>(told >> 4U) == step ? static_cast<FailureReason>(told & 15U)
                                                       : FailureReason::not_finite;
}

template <class ExecutionSpace>
void ContactOn<ExecutionSpace>::work(std::span<ContactWork> of_vertices) const {
  const auto& mirror = _work_on_host;
  device::copy(_instance.space(), mirror, _work);
  _instance.space().fence("drogue::fabric::contact_work");
  std::copy_n(mirror.data(), of_vertices.size(), of_vertices.begin());
}

template <class ExecutionSpace>
void ContactOn<ExecutionSpace>::set_work(std::span<const ContactWork> of_vertices) {
  const auto& mirror = _work_on_host;
  std::copy(of_vertices.begin(), of_vertices.end(), mirror.data());
  device::copy(_instance.space(), _work, mirror);
  _instance.space().fence("drogue::fabric::contact_work");
  keep();
}

template <class ExecutionSpace>
std::unique_ptr<ContactSteps<ExecutionSpace>> make_contact(const Parameters& parameters,
                                                           const ContactCloth<ExecutionSpace>& cloth) {
  return std::make_unique<ContactOn<ExecutionSpace>>(parameters, cloth);
}

}  // namespace drogue::fabric
