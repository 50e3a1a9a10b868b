#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/device/captured_graph.hpp"
#include "kernels/fabric/contact_steps.hpp"
#include "kernels/fabric/frequency.hpp"
#include "kernels/fabric/persistent_steps.hpp"
#include "kernels/fabric/prescribed.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/fabric/step.hpp"
#include "kernels/fabric/stress_on.hpp"
#include "kernels/fabric/totals.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, Law law>
struct ForceFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Bounds = Kokkos::LaunchBounds<>;
  Cloth<ExecutionSpace> cloth;
  PointsView<ExecutionSpace> x, out;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * device::Access<R>::lanes;
    store_points(out, i, force<law, R>(cloth, x, i));
  }
};

/// A solver of one model on one backend.
template <class ExecutionSpace, Law law>
class SolverOn final : public Solver {
 public:
  using Points = PointsView<ExecutionSpace>;

  explicit SolverOn(const Parameters& p);
  SolverOn(const SolverOn&) = delete;  // the recorded step knows where this one lies
  SolverOn& operator=(const SolverOn&) = delete;

  void upload(std::span<const Vector> positions, std::span<const Vector> velocities) override;
  void download(std::span<Vector> positions, std::span<Vector> velocities) override;
  bool advance(std::int64_t steps) override;
  std::optional<Failure> failure() override;
  [[nodiscard]] Clock clock() const override { return _clock; }
  void set_clock(const Clock& clock) override;
  void forces(std::span<Vector> forces) override;
  double fastest_frequency() override;
  double frequency_at_least() override;
  double fastest_decay() const override { return _decay; }
  void stress(StressMeasure measure, std::span<Stress> of_triangles) override;
  void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) override;
  Totals totals() override;
  [[nodiscard]] const char* driver() const override;
  void contact_work(std::span<ContactWork> of_vertices) override;
  void set_contact_work(std::span<const ContactWork> of_vertices) override;

 private:
  static constexpr int lanes = device::Access<
      std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>>::lanes;

  static_assert(slice % lanes == 0, "lanes must not straddle slices");

  [[nodiscard]] Points points(const std::string& label) const {
    return Points(label, static_cast<std::size_t>(_padded));
  }

  /// Of each pack of vertices; with as many blocks on a multiprocessor as run fastest there.
  template <class Functor>
  void launch(const char* label, const Functor& functor) const {
    launch_each<typename Functor::Bounds>(label, _padded / lanes, functor);
  }
  template <class Bounds = Kokkos::LaunchBounds<>, class Functor>
  void launch_each(const char* label, int count, const Functor& functor) const {
    static_assert(Kokkos::SpaceAccessibility<ExecutionSpace,
                                             typename PointsView<ExecutionSpace>::memory_space>::accessible);
    const Kokkos::RangePolicy<ExecutionSpace, Bounds> each(_instance.space(), 0, count);
    // What is light travels with the launch; else launches would wait for one another.
    Kokkos::parallel_for(
        label, Kokkos::Experimental::require(each, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
        functor);
  }

  [[nodiscard]] Points rest_places(const Parameters& p) const;
  void prepare_external(const Parameters& p);
  void prepare_motions(const Parameters& p);
  void make_persistent(const Parameters& p, const RingSlots& rings, const SpringSlots& springs);
  void record();
  void take_persistent(std::int64_t steps);
  [[nodiscard]] ProgramsView<ExecutionSpace> programs(
      const std::vector<device::ExpressionProgram>& from) const;
  [[nodiscard]] Timing<ExecutionSpace> timing(double part) const { return {_watch, _clock, _hand, part}; }
  /// Whether each stage is a kernel: where others must see it, and on hosts, whose few registers two stages
  /// at once would not fit.
  [[nodiscard]] bool goes_by_stages() const {
    return device::is_host<ExecutionSpace> || _acts || _prescribed;
  }
  [[nodiscard]] ExternalFunctor<ExecutionSpace> loads_at(const Points& x, const Points& v, double part,
                                                         bool damps) const;
  void act(const Points& x, const Points& v, double part, bool damps) const;
  void place(const Points& x, const Points& v, double part, bool looks) const;
  void runge_kutta_step() const;
  void runge_kutta_stages() const;
  template <bool last>
  void runge_kutta_half(const char* label) const;
  void verlet(bool ends, bool begins);
  void take(std::int64_t steps);
  void take_in_contact(std::int64_t steps);
  void keep();
  template <Law of>
  [[nodiscard]] double largest_row(const ListView<ExecutionSpace, double>& more) const;
  void make_sums();
  void forces_at(const Points& x, std::span<Vector> forces) const;
  void settle();
  void set_steps();
  [[nodiscard]] bool lost() const;
  void find_stress(StressMeasure measure, const StressView<ExecutionSpace>& to,
                   const TensorView<ExecutionSpace>& tensor);
  void stress_to_host(const StressView<ExecutionSpace>& from, std::span<Stress> to) const;
  void require_one_a_vertex(std::size_t count) const;
  void to_device(std::span<const Vector> from, const Points& to) const;
  void to_host(const Points& from, std::span<Vector> to) const;

  device::Instance<ExecutionSpace> _instance;
  Mesh _mesh;
  Material _material;
  int _vertices, _padded;  ///< in whole slices
  Integrator _integrator;
  Driver _driver;  ///< as asked for
  double _damping;
  double _decay;  ///< 1/s, that damping may have
  Clock _clock;
  Cloth<ExecutionSpace> _cloth;
  External<ExecutionSpace> _external;
  bool _acts = false;   ///< a kernel of its own computes loads
  bool _drags = false;  ///< dashpots pull
  std::optional<Prescribed<ExecutionSpace>> _prescribed;
  Watch<ExecutionSpace> _watch;
  int _hand = 0;  ///< of the watch, that tells the steps taken
  std::optional<Failure> _failure;
  Points _pull;                                   ///< of springs of vectors
  double _rest_energy = 0.0;                      ///< J, of theirs
  Points _dead;                                   ///< loads, N; may be empty
  std::vector<TotalsView<ExecutionSpace>> _sums;  ///< ever fewer rows, down to one
  typename TotalsView<ExecutionSpace>::HostMirror _sum;
  mutable typename Points::HostMirror _on_host;  ///< of a device, made when first asked for
  ListView<ExecutionSpace, double> _load_stiffness;
  Points _x, _v, _next;
  Points _kept_x, _kept_v;
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> _kept_step;
  Points _other, _velocity[3];  ///< of Runge and Kutta alone, the last one only by stages
  Points _dragged;              ///< of Verlet with dashpots
  std::optional<TriangleViews<ExecutionSpace>> _triangles;  ///< made when stress is asked for
  std::optional<device::CapturedGraph<ExecutionSpace>> _step;
  std::optional<Persistent<ExecutionSpace>> _persistent;
  std::unique_ptr<ContactSteps<ExecutionSpace>> _contact;  ///< none: nothing meets
};

template <class ExecutionSpace, bool tension_only>
std::unique_ptr<Solver> make_solver_of(const Parameters& p) {
  // Without triangles that resist both models of springs are the same kernel.
  switch (p.material.model) {
    case Model::quadratic:
      return std::make_unique<SolverOn<ExecutionSpace, Law{Model::quadratic, tension_only}>>(p);
    case Model::biquadratic:
      return std::make_unique<SolverOn<ExecutionSpace, Law{Model::biquadratic, tension_only}>>(p);
    default:
      return std::make_unique<SolverOn<ExecutionSpace, Law{Model::edge, tension_only}>>(p);
  }
}

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& p) {
  return p.material.tension_only ? make_solver_of<ExecutionSpace, true>(p)
                                 : make_solver_of<ExecutionSpace, false>(p);
}

}  // namespace drogue::fabric

#include "kernels/fabric/solver_on_external.hpp"
#include "kernels/fabric/solver_on_measures.hpp"
#include "kernels/fabric/solver_on_parts.hpp"
#include "kernels/fabric/solver_on_persistent.hpp"
#include "kernels/fabric/solver_on_steps.hpp"
#include "kernels/fabric/solver_on_stress.hpp"
