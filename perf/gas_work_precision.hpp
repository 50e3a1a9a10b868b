#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "miniapps/gas/repeated_run.hpp"
#include "miniapps/gas/scheme_names.hpp"

namespace drogue::perf {

/// One run to solution: a point of a diagram of error against time.
struct Solution {
  std::string problem;          ///< a shipped scene
  device::Backend backend;      ///< serial for the competitor
  gas_app::SchemeNames scheme;  ///< weno "muscl-hancock" and else empty for the competitor
  int weno_power = 1;
  std::int64_t cells = 0;
  gas_app::RepeatedRun run;
};

/// Runs the entropy wave, Shu-Osher, the blast waves, LeBlanc and Sod on doubling meshes in every combination
/// of WENO-JS, -Z, -M and TENO5, splitting, time scheme (CFL 0.6 and 1.2, the same work) and precision on
/// each of `backends`, and the MUSCL-Hancock scheme of `kernels/reference` beside them. A solution is passed
/// on as soon as it is there. `quick`: two small meshes of the wave and of Sod. Returns false after a signal.
bool gas_work_precision(const std::vector<device::Backend>& backends, bool quick,
                        const std::function<void(const Solution&)>& sink);

}  // namespace drogue::perf
