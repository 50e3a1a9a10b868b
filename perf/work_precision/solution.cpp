#include "perf/work_precision/solution.hpp"

#include <cmath>

namespace drogue::perf {

Solution solution_of(const framework::RepeatedRun& run, const std::string& error) {
  Solution s;
  s.samples = run.samples;
  s.steps = run.steps;
  s.code = run.code;
  s.message = run.message;
  if (s.code == ExitCode::ok) s.error = run.errors.at(error);
  s.sound = s.code == ExitCode::ok && std::isfinite(s.error);
  return s;
}

}  // namespace drogue::perf
