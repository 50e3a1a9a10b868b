#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "kernels/device/backend.hpp"
#include "miniapps/framework/study.hpp"

namespace drogue::perf {

/// One run to solution: a point of a work-precision diagram (error against time).
struct Solution {
  std::string problem;           ///< name of a shipped scene, or of a set of options
  device::Backend backend{};     ///< serial for the comparison scheme
  std::string label;             ///< label of the scheme
  nlohmann::json scheme;         ///< settings of the scheme, as facts of a record
  std::int64_t cells = 0;        ///< number of cells (flow: per axis), of vertices, or of intervals
  std::vector<double> samples;   ///< s; for options the time of a batch over its size
  std::int64_t steps = 0;        ///< time steps of a run
  double error = 0.0;            ///< against the exact solution; unset after a numerical failure
  bool sound = false;            ///< the error is finite, and conserved quantities are conserved
  ExitCode code = ExitCode::ok;  ///< numerical_failure comes with a `message`
  std::string message;
};

/// Solution of repeated runs of a scene, whose error is that of this name. It is sound if the error is
/// finite.
Solution solution_of(const framework::RepeatedRun& run, const std::string& error);

/// Receives each solution as soon as it is measured.
using SolutionSink = std::function<void(const Solution&)>;

/// Selection of backends and problems.
struct Selection {
  std::vector<device::Backend> backends;
  bool quick = false;
  std::function<bool(const std::string&)> wants;  ///< selects problems; called once for each name
};

// The functions below block until all solutions are measured, or return false after a signal. They throw
// Failure for a scene that cannot be read.

/// Runs the entropy wave, Shu-Osher, the blast waves, LeBlanc and Sod on doubling meshes on each backend. The
/// schemes are all combinations of WENO-JS, -Z, -M and TENO5, splitting, time scheme (CFL 0.6 and 1.2, equal
/// work) and precision. The MUSCL-Hancock scheme of `kernels/reference` is the comparison. `quick` selects
/// two small meshes of the wave and of Sod.
bool gas_work_precision(const Selection& selection, const SolutionSink& sink);

/// Runs two-dimensional vortices of Taylor and Green in a periodic cube, drifting and at rest, for 1 s on
/// successively halved cells on each backend, in all combinations of advection, time scheme (AB2 at CFL 0.5,
/// RK3 at 1) and direct pressure solver, and with implicit diffusion; by hypre with WENO-Z. The error is the
/// largest of the velocity along x, m/s. Then runs the lid-driven cavity at Re 100 until it is
/// steady by the schemes that solve directly; its error is the largest deviation of an extreme velocity on
/// the centre lines, m/s. `quick` selects two small grids, WENO-Z, the central scheme and transforms.
bool flow_work_precision(const Selection& selection, const SolutionSink& sink);

/// Opens a C-9 from its flat cloth in a stream of 10 m/s for 1 s on successively finer grids on each backend,
/// with finer cloth, other time steps and schemes, and other delta functions of the coupling.
/// `opening-impulse` is the momentum given to the air, `opening-time` the time of half of it. `porous-drag`
/// is the mean drag, from 1 to 2 s, of porous cloth that starts nearly open and hardly breathes. Errors are
/// relative to a solution on twice the cells per axis of the finest grid, with half the time step, computed
/// first; that of `porous-drag` has an inset of its edges of 0.55 cells. `quick` selects two small grids,
/// short flights and three discretizations.
bool parachute_work_precision(const Selection& selection, const SolutionSink& sink);

/// Prices the puts of `known_puts`, repeated to fill a batch, on each backend. Method `pide` runs in all
/// combinations of mesh, steps per interval, one or two grids, and exercise (in the solve, split off,
/// European); the baseline scheme on the same meshes where it supports the jumps; `cos` with decreasing
/// tolerances. The error is the largest of the batch, in units of the strike; the truth of European prices is
/// the COS price. `quick` selects two small meshes of the contract of [Shi] and of Merton jumps.
bool options_work_precision(const Selection& selection, const SolutionSink& sink);

/// Runs the drum, Hencky's membrane and the catenary on meshes with successively halved edges on each
/// backend, in all combinations of material model (cloth only), masses and integrator. The relative error is
/// that of the frequency, of the deflection at the centre, and of the farthest vertex over the span. `quick`
/// selects two small meshes of the drum and of the catenary.
bool springs_work_precision(const Selection& selection, const SolutionSink& sink);

}  // namespace drogue::perf
