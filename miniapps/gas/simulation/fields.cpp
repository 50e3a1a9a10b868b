#include "miniapps/gas/simulation/fields.hpp"

#include <algorithm>

namespace drogue::gas_app {

void for_chunks(std::int64_t cells, const std::function<void(std::int64_t, std::size_t)>& visit) {
  for (std::int64_t first = 0; first < cells; first += chunk_cells)
    visit(first, static_cast<std::size_t>(std::min(chunk_cells, cells - first)));
}

void upload_initial_state(gas::Solver& solver, const GasScene& scene) {
  const gas::Parameters& p = scene.parameters;
  const InitialState initial(scene);
  std::vector<double> rho, momentum, energy;
  for_chunks(p.cells, [&](std::int64_t first, std::size_t count) {
    rho.resize(count), momentum.resize(count), energy.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Primitive w = initial(cell_centre(p, first + static_cast<std::int64_t>(i)));
      rho[i] = w.rho;
      momentum[i] = w.rho * w.u;
      energy[i] = w.p / (p.gamma - 1.0) + 0.5 * w.rho * w.u * w.u;
    }
    solver.upload(first, {rho, momentum, energy});
  });
}

void for_cells(gas::Solver& solver, const gas::Parameters& parameters,
               const std::function<void(std::int64_t, const Primitive&)>& visit) {
  std::vector<double> rho, momentum, energy;
  for_chunks(parameters.cells, [&](std::int64_t first, std::size_t count) {
    rho.resize(count), momentum.resize(count), energy.resize(count);
    solver.download(first, {rho, momentum, energy});
    for (std::size_t i = 0; i < count; ++i)
      visit(first + static_cast<std::int64_t>(i), primitive({rho, momentum, energy}, i, parameters.gamma));
  });
}

}  // namespace drogue::gas_app
