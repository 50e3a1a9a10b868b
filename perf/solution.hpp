#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "kernels/device/backend.hpp"

namespace drogue::perf {

/// One run to solution: a point of a diagram of error against time.
struct Solution {
  std::string problem;           ///< a shipped scene, or a kind of option
  device::Backend backend;       ///< serial for a competitor
  std::string label;             ///< of the scheme
  nlohmann::json scheme;         ///< what it is, as facts of a record
  std::int64_t cells = 0;        ///< or vertices, or intervals of an option's mesh
  std::vector<double> samples;   ///< s; of an option its share of a batch
  std::int64_t steps = 0;        ///< time steps of a run
  double error = 0.0;            ///< against the exact solution
  bool sound = false;            ///< a number, and what is to be kept is kept
  ExitCode code = ExitCode::ok;  ///< a numerical failure, with `message`, has no error
  std::string message;
};

using SolutionSink = std::function<void(const Solution&)>;

/// What is to be solved.
struct SolutionsAsked {
  std::vector<device::Backend> backends;
  bool quick = false;
  std::function<bool(const std::string&)> wants;  ///< whether a problem is; called once for each, by its name
};

/// Runs the entropy wave, Shu-Osher, the blast waves, LeBlanc and Sod on doubling meshes in every combination
/// of WENO-JS, -Z, -M and TENO5, splitting, time scheme (CFL 0.6 and 1.2, the same work) and precision on
/// each backend, and the MUSCL-Hancock scheme of `kernels/reference` beside them. A solution is passed
/// on as soon as it is there. `quick`: two small meshes of the wave and of Sod. Returns false after a signal.
bool gas_work_precision(const SolutionsAsked& asked, const SolutionSink& sink);

/// Prices the puts of `known_puts`, repeated to a batch, by `pide` in every combination of mesh, steps a
/// mesh, one grid or two, and exercise (in the solve, split off, European), by the dissertation's scheme on
/// the same meshes where it has the jumps, and by `cos` to falling tolerances, on each backend. Errors
/// are the largest of a price over the strike; European prices are held against Fourier's integral. `quick`:
/// two small meshes of the dissertation's contract and of Merton's jumps. Returns false after a signal.
bool options_work_precision(const SolutionsAsked& asked, const SolutionSink& sink);

/// Runs the drum, Hencky's membrane and the catenary on meshes whose edges are halved, in every combination
/// of model (of cloth), masses and integrator on each backend. Errors are relative: of the frequency,
/// of the deflection at the centre, and of the farthest vertex over the span. `quick`: two small meshes of
/// the drum and of the catenary. Returns false after a signal.
bool springs_work_precision(const SolutionsAsked& asked, const SolutionSink& sink);

}  // namespace drogue::perf
