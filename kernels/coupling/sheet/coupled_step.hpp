#pragma once

#include <Kokkos_Core.hpp>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kernels/coupling/sharp/sharp_sheet.hpp"
#include "kernels/coupling/sheet/air_drag.hpp"
#include "kernels/coupling/sheet/coupled_fabric.hpp"
#include "kernels/coupling/sheet/immersed_sheet.hpp"
#include "kernels/coupling/sheet/line_strength.hpp"
#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/flow/flow_solver.hpp"
#include "kernels/stepping/state_list.hpp"

namespace drogue::coupling {

/// Step of the flow at whose beginning the state was saved.
template <class ExecutionSpace>
using SavedStep = Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space>;

/// Saves the state at the beginning of a step of the flow. After the flow has stopped, only the state at the
/// end of its last step is new.
template <class ExecutionSpace>
struct SaveStateFunctor {
  flow::ControlView<ExecutionSpace> control;
  SavedStep<ExecutionSpace> saved_step;
  stepping::CopyStateFunctor<ExecutionSpace> save;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (control().trial.stop != flow::Stop::running && control().now.step == saved_step()) return;
    save(i);
  }
};

/// Kernel of one thread that completes `SaveStateFunctor`, and stops the flow before its step if the cloth
/// has failed.
template <class ExecutionSpace>
struct CheckClothFunctor {
  using ReasonView = Kokkos::View<FailureReason, typename ExecutionSpace::memory_space>;

  flow::ControlView<ExecutionSpace> control;
  SavedStep<ExecutionSpace> saved_step;
  stepping::StepMonitor<ExecutionSpace> cloth;
  GridTransfer<ExecutionSpace> transfer;
  ReasonView reason;
  Kokkos::View<int, typename ExecutionSpace::memory_space> broken_line, failed_line;

  KOKKOS_FUNCTION void operator()(int) const {
    saved_step() = control().now.step;
    const int broken = broken_line();
    broken_line() = no_line;
    if (control().trial.stop != flow::Stop::running) return;
    const TransferCounts counts = transfer.counts();
    FailureReason found = FailureReason::flow;
    if (counts.incomplete_points > 0) found = FailureReason::left_domain;
    if (counts.rejected_forces > 0) found = FailureReason::not_spread;
    if (broken != no_line) found = FailureReason::line;
    if (cloth.has_failed()) found = FailureReason::cloth;
    if (found == FailureReason::flow) return;
    if (found == FailureReason::line) failed_line() = broken;
    reason() = found;
    control().trial.stop = flow::Stop::failed;
  }
};

/// Sheet of the method of the parameters. Throws as the constructor of `Sheet`.
template <class ExecutionSpace, class... Arguments>
std::unique_ptr<Sheet<ExecutionSpace>> make_sheet(CouplingMethod method, const Arguments&... arguments) {
  if (method == CouplingMethod::sharp) return std::make_unique<SharpSheet<ExecutionSpace>>(arguments...);
  return std::make_unique<ImmersedSheet<ExecutionSpace>>(arguments...);
}

/// A step of flow and cloth, and the state that it saves at its beginning. Steps neither wait for the host
/// nor copy to it nor allocate, on several ranks if `flow::Step::is_asynchronous`.
template <class ExecutionSpace>
class CoupledStep {
 public:
  using Flow = flow::FlowSolver<ExecutionSpace>;
  using Fabric = fabric::FabricSolver<ExecutionSpace, AirRelaxation<ExecutionSpace>>;
  using StateList = stepping::StateList<ExecutionSpace>;

  /// Refers to its parts, which must outlive it. Blocks. Throws as the constructor of `LineStrength`.
  CoupledStep(const ExecutionSpace& space, const Parameters& parameters, Flow& flow,
              const Sheet<ExecutionSpace>& sheet, const AirDrag<ExecutionSpace>& drag, Fabric& fabric)
      : _space(space),
        _flow(flow),
        _sheet(sheet),
        _drag(drag),
        _fabric(fabric),
        _box(flow::force_box(parameters.flow)),
        _state(sheet.state()),
        _saved_step("drogue::coupling::saved_step"),
        _reason("drogue::coupling::failure_reason"),
        _strength(space, parameters) {
    _state.add("sheet_position", "m", fabric.state().positions, fabric.vertices());
    _state.add("sheet_velocity", "m/s", fabric.state().velocities, fabric.vertices());
    _drag.add_state(_state);
    _saved = typename StateList::Packed("drogue::coupling::saved_state", _state.size());
  }

  /// Enqueues a step of dt, s, of the flow with so many steps of the cloth; numbers are those of the
  /// equations in docs/coupling.md. `is_first`: no step precedes this one.
  void enqueue(double dt, std::int64_t substeps, bool is_first) const {
    const auto cloth = _fabric.state();
    const auto u = faces(_flow.velocity()), f = faces(_flow.force());

    clear_forces(f);  // not before: the pressure of an output contains those of the last step
    save();
    _sheet.freeze(_space, cloth, dt);                    // (1), (2): weights, area, normal, row sum
    _sheet.interpolate_air(_space, u);                   // (3): copies of the air
    _drag.begin_step(_space, cloth, u, dt);              // of lines and payloads
    static_cast<void>(_fabric.enqueue_steps(substeps));  // (4) to (6): cloth and copies relax
    _sheet.spread_forces(_space, cloth, f, dt);          // (7)
    _drag.spread_forces(_space, f, dt);
    check();
    _flow.enqueue_step();                                                     // (8)
    _sheet.filter_acceleration(_space, u, f, dt, is_first, _flow.control());  // (9)
  }

  /// Velocity of the flow at the present positions of all vertices, as `Sheet::air_velocity`.
  [[nodiscard]] const auto& air_velocity() const {
    return _sheet.air_velocity(_space, _fabric.state(), faces(_flow.velocity()));
  }

  /// Arrays of the state. Does not throw.
  [[nodiscard]] const StateList& state() const { return _state; }
  /// For the time of pulls. Does not throw.
  [[nodiscard]] const SavedStep<ExecutionSpace>& saved_step() const { return _saved_step; }

  /// Enqueues what a change of the state makes necessary, but for the forces on the air. The fabric forgets a
  /// failure. Blocks. Throws std::invalid_argument for positions and velocities that are not finite.
  void renew() const {
    std::vector<fabric::Vector> positions(static_cast<std::size_t>(_fabric.vertices())),
        velocities(positions.size());
    _state.download(_space, "sheet_position", numbers(positions));
    _state.download(_space, "sheet_velocity", numbers(velocities));
    _fabric.upload(positions, velocities);
  }

  /// True if the last state saved is that at the beginning of this step of the flow. Blocks.
  [[nodiscard]] bool was_saved_at(std::int64_t step) const { return read(_saved_step) == step; }

  /// Returns the cloth, and the forces on the air, to the state that was saved. Forces of a sharp sheet
  /// return smoothed; they enter the pressure of an output alone. Blocks.
  void roll_back() const {
    Kokkos::deep_copy(_space, _sheet.transfer().counts, TransferCounts{});
    const auto f = faces(_flow.force());
    clear_forces(f);  // before the places of the discarded step are lost
    device::launch_each(_space, "drogue::coupling::roll_back", _state.most_rows(), copy_state(false));
    renew();
    _sheet.spread_again(_space, f);
    _drag.spread_again(_space, f);
    _space.fence("drogue::coupling::roll_back");
  }

  /// Forgets former steps and failures. Blocks.
  void start() const {
    _sheet.forget_steps(_space);
    _drag.forget_force(_space);
    forget_failures();
  }
  /// The same with an array of the state that has been restored.
  void restore() const {
    _sheet.forget_force(_space);
    _drag.forget_force(_space);
    forget_failures();
  }

  /// Reason of the last failure, and the number in the mesh of the first line that was too weak. Block.
  [[nodiscard]] FailureReason reason() const { return read(_reason); }
  [[nodiscard]] int failed_line() const { return read(_strength.failed()); }
  void set_reason(FailureReason reason) const {
    Kokkos::deep_copy(_space, _reason, reason);
    _space.fence("drogue::coupling::set_reason");
  }

  /// Sets E A of every line of the mesh, N. Blocks.
  void set_line_stiffness(std::span<const double> of_lines) {
    _strength.set_stiffness(_space, of_lines);
    _drag.set_line_stiffness(_space, of_lines);
  }

 private:
  [[nodiscard]] auto faces(const flow::List<ExecutionSpace>& values) const {
    return flow::face_views<ExecutionSpace>(_flow.grid(), _box, values);
  }
  template <class View>
  [[nodiscard]] typename View::non_const_value_type read(const View& view) const {
    typename View::non_const_value_type value{};
    Kokkos::deep_copy(_space, value, view);
    _space.fence("drogue::coupling::read");
    return value;
  }
  void clear_forces(const FaceViews<flow::FaceView<ExecutionSpace>>& f) const {
    _sheet.clear_forces(_space, f);
    _drag.clear_forces(_space, f);
  }
  void forget_failures() const {
    Kokkos::deep_copy(_space, _sheet.transfer().counts, TransferCounts{});
    _strength.reset(_space);
    Kokkos::deep_copy(_space, _saved_step, std::int64_t{-1});
    set_reason(FailureReason::flow);
  }
  [[nodiscard]] stepping::CopyStateFunctor<ExecutionSpace> copy_state(bool packs) const {
    return {_state, _saved, packs};
  }
  void save() const {
    device::launch_each(_space, "drogue::coupling::save_state", _state.most_rows(),
                        SaveStateFunctor<ExecutionSpace>{_flow.control(), _saved_step, copy_state(true)});
  }
  void check() const {
    _strength.check(_space, _fabric.state().positions);
    device::launch_each(_space, "drogue::coupling::check_cloth", 1,
                        CheckClothFunctor<ExecutionSpace>{.control = _flow.control(),
                                                          .saved_step = _saved_step,
                                                          .cloth = _fabric.monitor(),
                                                          .transfer = _sheet.transfer(),
                                                          .reason = _reason,
                                                          .broken_line = _strength.broken(),
                                                          .failed_line = _strength.failed()});
  }

  ExecutionSpace _space;
  Flow& _flow;
  const Sheet<ExecutionSpace>& _sheet;
  const AirDrag<ExecutionSpace>& _drag;
  Fabric& _fabric;
  flow::Core _box;  ///< of the grid, that sheets lie in
  StateList _state;
  typename StateList::Packed _saved;
  SavedStep<ExecutionSpace> _saved_step;
  typename CheckClothFunctor<ExecutionSpace>::ReasonView _reason;
  LineStrength<ExecutionSpace> _strength;
};

}  // namespace drogue::coupling
