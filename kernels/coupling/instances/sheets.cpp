#include "kernels/coupling/sharp/sharp_sheet.hpp"
#include "kernels/coupling/sheet/air_drag.hpp"
#include "kernels/coupling/sheet/immersed_sheet.hpp"

namespace drogue::coupling {

template class AirDrag<DROGUE_INSTANCE_SPACE>;
template class Sheet<DROGUE_INSTANCE_SPACE>;
template class ImmersedSheet<DROGUE_INSTANCE_SPACE>;
template class SharpSheet<DROGUE_INSTANCE_SPACE>;

template <class ExecutionSpace>
std::unique_ptr<Sheet<ExecutionSpace>> make_sheet(
    const ExecutionSpace& space, const StaggeredGrid& grid, const fabric::Mesh& mesh,
    std::span<const fabric::Vector> inverse_mass, const SheetParameters& parameters, double density,
    const linear::DeviceCommunicator<ExecutionSpace>& communicator, const FaceWindow& own_faces) {
  if (parameters.method == CouplingMethod::sharp)
    return std::make_unique<SharpSheet<ExecutionSpace>>(space, grid, mesh, inverse_mass, parameters, density,
                                                        communicator, own_faces);
  return std::make_unique<ImmersedSheet<ExecutionSpace>>(space, grid, mesh, inverse_mass, parameters, density,
                                                         communicator, own_faces);
}
template std::unique_ptr<Sheet<DROGUE_INSTANCE_SPACE>> make_sheet(
    const DROGUE_INSTANCE_SPACE&, const StaggeredGrid&, const fabric::Mesh&, std::span<const fabric::Vector>,
    const SheetParameters&, double, const linear::DeviceCommunicator<DROGUE_INSTANCE_SPACE>&,
    const FaceWindow&);

}  // namespace drogue::coupling
