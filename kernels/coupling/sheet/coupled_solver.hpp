#pragma once

#include <cmath>
#include <optional>
#include <stdexcept>

#include "kernels/coupling/sheet/immersed_sheet.hpp"
#include "kernels/fabric/fabric_solver.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/flow/flow_solver.hpp"

namespace drogue::coupling {

/// Parameters of cloth in air.
struct CoupledParameters {
  flow::Parameters flow;      ///< with `external_force` and a positive `fixed_dt`, on one rank
  fabric::Parameters fabric;  ///< integrator and dt are replaced by those of the coupling
  SheetParameters sheet;      ///< its density is replaced by that of the flow
  int substeps = 1;           ///< steps of the cloth in a step of the flow, >= 1
};

/// Cloth in incompressible flow on the caller's instance of an execution space. Each step of the flow holds
/// `substeps` steps of the cloth by the symplectic Euler method and one exchange of impulses
/// (`ImmersedSheet`). The forces on the air and on the cloth are equal and opposite to round-off.
template <class ExecutionSpace>
class CoupledSolver {
 public:
  using Flow = flow::FlowSolver<ExecutionSpace>;
  using Fabric = fabric::FabricSolver<ExecutionSpace, AirRelaxation<ExecutionSpace>>;

  /// Fluid at rest and cloth at rest in its mesh; set other states by `flow` and `fabric`, then call
  /// `Flow::start`. `instance` must outlive the solver. Blocks. Throws std::invalid_argument for parameters
  /// out of range.
  CoupledSolver(const device::Instance<ExecutionSpace>& instance, const CoupledParameters& parameters)
      : _space(instance.space()),
        _dt(parameters.flow.fixed_dt),
        _substeps(checked(parameters).substeps),
        _flow(instance, parameters.flow),
        _sheet(instance.space(), flow::coupling_grid(_flow.grid()), parameters.fabric,
               sheet_parameters(parameters)),
        _fabric(instance.space(), fabric_parameters(parameters), _sheet.relaxation()) {}

  [[nodiscard]] Flow& flow() { return _flow; }
  [[nodiscard]] Fabric& fabric() { return _fabric; }
  [[nodiscard]] const ImmersedSheet<ExecutionSpace>& sheet() const { return _sheet; }

  /// Enqueues `count` steps of the flow. Asynchronous but for the bound on the steps of the cloth in flight.
  /// Returns false, and enqueues nothing more, once a failure of the cloth is known on the host. Throws
  /// std::runtime_error after a failed kernel.
  bool enqueue_steps(std::int64_t count) {
    const auto velocity = flow::face_views<ExecutionSpace>(_flow.grid(), _flow.velocity()),
               density = flow::face_views<ExecutionSpace>(_flow.grid(), _flow.force());
    for (std::int64_t k = 0; k < count; ++k) {
      _sheet.begin_step(_space, _fabric.state(), velocity, _dt);
      if (!_fabric.enqueue_steps(_substeps)) return false;
      Kokkos::deep_copy(_space, _flow.force(), 0.0);
      _sheet.spread_forces(_space, density, _dt);
      // Far ahead, so that no step is shorter than dt.
      _flow.enqueue_steps(1e300, 1);
      _sheet.end_step(_space, velocity, density, _dt, _is_first);
      _is_first = false;
    }
    return true;
  }

 private:
  static const CoupledParameters& checked(const CoupledParameters& p) {
    if (!(p.flow.fixed_dt > 0.0) || !p.flow.external_force)
      throw std::invalid_argument("coupled solver: the flow needs an external force and a fixed dt");
    if (p.substeps < 1) throw std::invalid_argument("coupled solver: there must be one substep at least");
    return p;
  }
  static SheetParameters sheet_parameters(const CoupledParameters& p) {
    SheetParameters sheet = p.sheet;
    sheet.density = p.flow.density;
    return sheet;
  }
  static fabric::Parameters fabric_parameters(const CoupledParameters& p) {
    fabric::Parameters cloth = p.fabric;
    cloth.integrator = fabric::Integrator::symplectic_euler;
    cloth.dt = p.flow.fixed_dt / p.substeps;
    return cloth;
  }

  ExecutionSpace _space;
  double _dt;  ///< s, of the flow
  int _substeps;
  bool _is_first = true;
  Flow _flow;
  ImmersedSheet<ExecutionSpace> _sheet;
  Fabric _fabric;
};

}  // namespace drogue::coupling
