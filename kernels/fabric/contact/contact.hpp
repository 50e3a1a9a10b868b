#pragma once

#include <memory>
#include <span>

#include "kernels/device/instance.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/stepping/step_monitor.hpp"

namespace drogue::fabric {

/// What contact does about a step of a solver, whatever the law of its cloth. Nothing here waits but what is
/// said to.
template <class ExecutionSpace>
class ContactHandler {
 public:
  using Points = PointsView<ExecutionSpace>;
  virtual ~ContactHandler() = default;

  /// Before a step: changes velocities, so that parts that would meet do not.
  virtual void begin(const Points& x, const Points& v) = 0;

  /// After it: where parts have crossed all the same, puts them back as rigid zones; raises the monitor where
  /// that does not help.
  virtual void end(const Points& x, const Points& v) = 0;

  /// s, of the steps to come.
  virtual void set_dt(double dt) = 0;

  /// Forgets where vertices were and what went wrong, for they have been put elsewhere.
  virtual void forget() = 0;

  /// Puts the work aside with a state, unless one before it was lost; goes back to it.
  virtual void keep() = 0;
  virtual void go_back() = 0;

  /// Why step `step` was lost. Waits.
  [[nodiscard]] virtual FailureReason reason(std::int64_t step) const = 0;

  /// What contact has done on every vertex so far. Both wait.
  virtual void work(std::span<ContactWork> of_vertices) const = 0;
  virtual void set_work(std::span<const ContactWork> of_vertices) = 0;
};

/// What a solver lends to contact.
template <class ExecutionSpace>
struct ContactInputs {
  const device::Instance<ExecutionSpace>& instance;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> inverse_mass;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> fixed_dofs;  ///< as of Cloth
  StepMonitor<ExecutionSpace> monitor;
};

template <class ExecutionSpace>
[[nodiscard]] std::unique_ptr<ContactHandler<ExecutionSpace>> make_contact(
    const Parameters& parameters, const ContactInputs<ExecutionSpace>& cloth);

}  // namespace drogue::fabric
