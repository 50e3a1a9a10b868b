#pragma once

#include <memory>
#include <span>

#include "kernels/device/instance.hpp"
#include "kernels/fabric/contact/contact_parameters.hpp"
#include "kernels/fabric/integrator.hpp"
#include "kernels/fabric/material.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/stepping/divergence.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Contact handling around the steps of a solver with any constitutive model: in every step, or for all steps
/// of an interval together (`Contact::interval`). Asynchronous unless stated.
template <class ExecutionSpace>
class ContactHandler {
 public:
  using Points = PointsView<ExecutionSpace>;
  virtual ~ContactHandler() = default;

  /// Applies impulses to the velocities before a step, so that approaching parts do not meet.
  virtual void begin_step(const Points& x, const Points& v) = 0;

  /// Moves parts that have crossed all the same as rigid impact zones; records a failure in the monitor if
  /// that is not enough.
  virtual void end_step(const Points& x, const Points& v) = 0;

  /// Sets dt, s, of the following steps.
  virtual void set_dt(double dt) = 0;

  /// Stores the positions before the steps of an interval of the given duration, s.
  virtual void begin_interval(const Points& x, double duration) = 0;

  /// Corrects the displacements in the interval, and the velocities at its end by the same impulses, so that
  /// parts do not meet; then as `end_step`.
  virtual void end_interval(const Points& x, const Points& v) = 0;

  /// Discards neighbour lists and recorded failures after a change of the positions. Blocks.
  virtual void reset() = 0;

  /// Work on every vertex so far, J, a part of the state. Does not throw.
  [[nodiscard]] virtual const ListView<ExecutionSpace, ContactWork>& work() const = 0;

  /// Lines without stiffness, E A in N of every line of the mesh, become no obstacles; the others become
  /// obstacles. Blocks.
  virtual void set_line_stiffness(std::span<const double> of_lines) = 0;

  /// Reason of the failure of step `step`. Blocks.
  [[nodiscard]] virtual FailureReason reason(std::int64_t step) const = 0;
};

/// Inputs of contact, owned by the solver.
template <class ExecutionSpace>
struct ContactInputs {
  const device::Instance<ExecutionSpace>& instance;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> inverse_mass;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> fixed_dofs;  ///< as in FabricViews
  StepMonitor<ExecutionSpace> monitor;
};

/// Contact handler for bodies and the self-contact of a mesh, with steps of dt, s. Blocks. Throws
/// std::runtime_error if memory runs out.
template <class ExecutionSpace>
[[nodiscard]] std::unique_ptr<ContactHandler<ExecutionSpace>> make_contact(
    const Mesh& mesh, const Contact& contact, Driver driver, double dt,
    const ContactInputs<ExecutionSpace>& inputs);

}  // namespace drogue::fabric
