#include "kernels/coupling/sheet/restart_state.hpp"

namespace drogue::coupling {

RestartState download_restart_state(Solver& solver, std::size_t vertices) {
  RestartState state;
  for (auto* values : {&state.positions, &state.velocities, &state.air_acceleration, &state.forces})
    values->resize(vertices);
  solver.download_cloth(state.positions, state.velocities);
  solver.download_air_acceleration(state.air_acceleration);
  solver.forces(state.forces);
  state.defect = solver.download_defect();
  state.face_acceleration = solver.download_face_acceleration();
  state.block = solver.block();
  state.frame = solver.frame();
  return state;
}

void upload_restart_state(Solver& solver, const RestartState& state) {
  solver.upload_cloth(state.positions, state.velocities);
  solver.upload_air_acceleration(state.air_acceleration);
  solver.upload_forces(state.forces);
  solver.upload_defect(state.defect);
  solver.upload_face_acceleration(state.face_acceleration);
  solver.set_block(state.block);
  solver.set_frame(state.frame);
}

}  // namespace drogue::coupling
