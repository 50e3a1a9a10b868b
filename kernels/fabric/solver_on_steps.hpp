#pragma once

// Definitions of SolverOn: steps, and what becomes of a state that is lost.

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, ConstitutiveModel law>
template <bool last>
void SolverOn<ExecutionSpace, law>::runge_kutta_half(const char* label) const {
  launch(label, RungeKuttaHalfFunctor<ExecutionSpace, law, last>{
                    _cloth, _x, _v, _next, _other, {_velocity[0], _velocity[1]}, _watch, _clock.dt});
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::runge_kutta_step() const {
  if (goes_by_stages()) return runge_kutta_stages();
  if constexpr (!device::is_host<ExecutionSpace>) {
    runge_kutta_half<false>("drogue::fabric::rk4_begin");
    runge_kutta_half<true>("drogue::fabric::rk4_end");
  }
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::runge_kutta_stages() const {
  const Points at[] = {_x, _next, _other, _next}, next[] = {_next, _other, _next, _x};
  // Of the step that has gone by before a stage, and after it.
  const double before[] = {0.0, 0.5, 0.5, 1.0}, after[] = {0.5, 0.5, 1.0, 0.0};
  for (int stage = 0; stage < 4; ++stage) {
    if (_acts) act(at[stage], stage == 0 ? _v : _velocity[stage - 1], before[stage], _drags);
    launch("drogue::fabric::rk4_stage",
           RungeKuttaFunctor<ExecutionSpace, law>{_cloth,
                                                  _x,
                                                  _v,
                                                  at[stage],
                                                  next[stage],
                                                  {_velocity[0], _velocity[1], _velocity[2]},
                                                  _watch,
                                                  _clock.dt,
                                                  stage});
    // The last stage has counted the step.
    if (_prescribed) place(next[stage], stage == 3 ? _v : _velocity[stage], after[stage], stage == 3);
  }
}

/// A step at the present dt, if it is to be replayed.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::record() {
  if (_integrator == Integrator::rk4 && !_persistent && _driver != Driver::plain)
    _step.emplace(_instance, [this](const ExecutionSpace&) { runge_kutta_step(); });
}

template <class ExecutionSpace, ConstitutiveModel law>
const char* SolverOn<ExecutionSpace, law>::driver() const {
  return _persistent ? "persistent" : _step ? _step->driver : "plain";
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::verlet(bool ends, bool begins) {
  if (_acts) act(_x, _v, 0.0, false);
  launch("drogue::fabric::verlet",
         VerletFunctor<ExecutionSpace, law>{_cloth, _x, _v, _next, _watch, _damping, _clock.dt, _hand, ends,
                                            begins, !_drags});
  if (!begins) return;
  if (_drags) {
    launch_each("drogue::fabric::drag", _vertices,
                DragFunctor<ExecutionSpace>{_cloth, _external.dashpots, _x, _v, _dragged, _next, _clock.dt});
    std::swap(_v, _dragged);
  }
  std::swap(_x, _next);
  _hand = 1 - _hand;
  if (_prescribed) place(_x, _v, 0.0, true);
}

/// Takes steps without a look at what becomes of them.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::take(std::int64_t steps) {
  if (_contact) return take_in_contact(steps);
  if (_integrator == Integrator::rk4) {
    if (_persistent)
      take_persistent(steps);
    else if (_step)
      for (std::int64_t step = 0; step < steps; ++step) _step->launch();
    else
      for (std::int64_t step = 0; step < steps; ++step) runge_kutta_step();
  } else {
    verlet(false, true);
    for (std::int64_t step = 1; step < steps; ++step) verlet(true, true);
    verlet(true, false);
  }
  _clock.step += steps;
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::take_in_contact(std::int64_t steps) {
  for (std::int64_t step = 0; step < steps; ++step) {
    _contact->begin(_x, _v);
    if (_integrator == Integrator::verlet) {
      verlet(false, true);
      verlet(true, false);
    } else if (_step) {
      _step->launch();
    } else {
      runge_kutta_step();
    }
    _contact->end(_x, _v);
  }
  _clock.step += steps;
}

template <class ExecutionSpace, ConstitutiveModel law>
bool SolverOn<ExecutionSpace, law>::advance(std::int64_t steps) {
  // Copies fall on multiples, so that they are the same however steps are cut into calls.
  while (steps > 0 && !lost()) {
    const std::int64_t part = std::min(steps, keep_every - _clock.step % keep_every);
    take(part);
    if (_clock.step % keep_every == 0) keep();
    steps -= part;
  }
  return !lost();
}

/// What the device has told so far, without waiting.
template <class ExecutionSpace, ConstitutiveModel law>
bool SolverOn<ExecutionSpace, law>::lost() const {
  return _failure || *static_cast<const volatile int*>(_watch.raised.data()) != 0;
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::keep() {
  Kokkos::parallel_for(
      "drogue::fabric::keep",
      Kokkos::Experimental::require(Kokkos::RangePolicy<ExecutionSpace>(_instance.space(), 0, _padded),
                                    Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      KeepFunctor<ExecutionSpace>{_watch, _x, _v, _kept_x, _kept_v, _kept_step, _hand});
  if (_contact) _contact->keep();
}

/// Waits; where a state was lost, goes back to the one kept.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::settle() {
  const ExecutionSpace& space = _instance.space();
  space.fence("drogue::fabric::settle");
  if (_failure || !lost()) return;
  std::uint64_t first = 0;
  Kokkos::deep_copy(space, first, _watch.lost);
  std::int64_t kept = 0;
  Kokkos::deep_copy(space, kept, _kept_step);
  device::copy(space, _x, _kept_x);
  device::copy(space, _v, _kept_v);
  space.fence("drogue::fabric::kept");
  _clock.step = static_cast<std::int64_t>(first >> 31U);
  _failure = Failure{static_cast<std::int64_t>(first & 0x7fffffffU), _clock.step, _clock.time(),
                     _contact ? _contact->trouble(_clock.step) : Trouble::not_finite};
  if (_contact) _contact->go_back();
  _clock.step = kept;
}

template <class ExecutionSpace, ConstitutiveModel law>
std::optional<Failure> SolverOn<ExecutionSpace, law>::failure() {
  settle();
  return _failure;
}

/// Sets the watch to the clock and to nothing lost.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::set_steps() {
  const ExecutionSpace& space = _instance.space();
  Kokkos::deep_copy(space, _watch.steps, _clock.step);
  Kokkos::deep_copy(space, _watch.lost, none_lost);
  space.fence("drogue::fabric::set_steps");
  _watch.raised() = 0;
  _hand = 0;
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::set_clock(const Clock& clock) {
  if (!(clock.dt > 0.0 && std::isfinite(clock.dt) && std::isfinite(clock.start)))
    throw std::invalid_argument("fabric solver: dt must be positive, and time finite");
  settle();
  _clock = clock;
  set_steps();
  if (_prescribed && !_failure) place(_x, _v, 0.0, true);
  keep();
  if (_contact) _contact->set_dt(_clock.dt);
  record();
}

}  // namespace drogue::fabric
