#include "kernels/device/own_instance.hpp"
#include "kernels/fabric/fabric_solver.hpp"
#include "kernels/fabric/host_threads.hpp"

namespace drogue::fabric {

template struct FabricForces<DROGUE_INSTANCE_SPACE>;
template class FabricSolver<DROGUE_INSTANCE_SPACE>;

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& p) {
  return std::make_unique<device::OnOwnInstance<ExecutionSpace, FabricSolver<ExecutionSpace>>>(
      host_threads(p.mesh.rest.size()), p);
}

template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

}  // namespace drogue::fabric
