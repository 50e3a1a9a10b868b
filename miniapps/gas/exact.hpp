#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernels/gas/solver.hpp"
#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {

/// The solution a run is compared with: state at `x` (m) and the end time.
using ExactSolution = std::function<Primitive(double x)>;

/// A finer own run at the end time: where no closed form exists.
struct Reference {
  std::vector<double> x, rho, u, p;
};

/// Runs the scene with `scene.verify.reference` on `backend`, its progress shown unless `quiet`; nothing if a
/// signal ended it. Throws Failure if that run fails.
std::optional<Reference> run_reference(const GasScene& scene, device::Backend backend, bool quiet);

/// What `scene.verify.exact` names; `reference` must be filled for `Exact::reference`.
ExactSolution exact_solution(const GasScene& scene, double time, const Reference& reference);

/// L1 (sum |e| dx), L2 (sqrt(sum e^2 dx)) and L-infinity norms of the error at the cell centres, for density,
/// velocity and pressure, by the names of the scene's tolerances.
std::map<std::string, double> error_norms(gas::Solver& solver, const gas::Parameters& parameters,
                                          const ExactSolution& exact);

}  // namespace drogue::gas_app
