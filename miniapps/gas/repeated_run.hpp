#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "common/study/repeats.hpp"
#include "miniapps/gas/exact.hpp"

namespace drogue::gas_app {

using study::Repeats;

/// The runs of one scene, which writes nothing while it is timed.
struct RepeatedRun {
  std::vector<double> samples;  ///< compute time of each run, s
  std::int64_t steps = 0;
  std::map<std::string, double> errors;  ///< as `error_norms` names them
  double conservation = 0.0;             ///< largest relative change that boundary fluxes do not explain
  ExitCode code = ExitCode::ok;          ///< a numerical failure, with `message`, leaves all else empty
  std::string message;
};

/// Runs `scene`, without its outputs, until `repeats` says stop. `code` is `interrupted` after a signal.
RepeatedRun run_repeatedly(const GasScene& scene, device::Backend backend, const ExactSolution& exact,
                           const Repeats& repeats);

}  // namespace drogue::gas_app
