#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernels/gas/solver.hpp"
#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

/// Exact solution at the end time: state at `x`, m.
using ExactSolution = std::function<Primitive(double x)>;

/// Result of a finer run at the end time, for scenes without a closed form.
struct Reference {
  std::vector<double> x, rho, u, p;
};

/// Runs the scene with `scene.verify.reference` on `backend`; shows progress unless `quiet`. Returns nothing
/// after a signal. Throws `Failure` (numerical_failure).
std::optional<Reference> run_reference(const GasScene& scene, device::Backend backend, bool quiet);

/// Solution that `scene.verify.exact` names at `time`, s. Keeps a reference to `reference`, which must be
/// filled for `Exact::reference`.
ExactSolution exact_solution(const GasScene& scene, double time, const Reference& reference);

/// Norms of the error at the cell centres by the names of the scene's tolerances: L1 (sum |e| dx), L2
/// (sqrt(sum e^2 dx)) and L-infinity of density, velocity and pressure, in SI units.
std::map<std::string, double> error_norms(gas::Solver& solver, const gas::Parameters& parameters,
                                          const ExactSolution& exact);

}  // namespace drogue::gas_app
