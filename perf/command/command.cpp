#include "perf/command/command.hpp"

#include <algorithm>

#include "common/program/program.hpp"
#include "common/program/signals.hpp"
#include "common/scene/nearest.hpp"

namespace drogue::perf {

void require(device::Backend backend) {
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
}

std::vector<device::Backend> backends_of(const std::string& name) {
  const device::Backend wanted = device::wanted_backend(name);
  require(wanted);
  if (name != "auto") return {wanted};
  std::vector<device::Backend> present;
  for (const device::Backend backend : device::compiled_backends())
    if (device::is_present(backend)) present.push_back(backend);
  return present;
}

ExitCode code_of(bool passed) {
  if (interrupted()) {
    print_notice("drogue-perf", "interrupted by a signal; the records hold the samples until then");
    return ExitCode::interrupted;
  }
  return passed ? ExitCode::ok : ExitCode::verification_failed;
}

namespace {

const std::vector<std::string> app_names = {"gas", "springs", "options", "flow", "parachute"};

}  // namespace

std::string app_help(const std::string& purpose) {
  return purpose + ": gas, springs, options, flow (that of drogue-parachute) or parachute";
}

void require_app(const std::string& app) { require_name("app", app, app_names); }

void require_name(const std::string& kind, const std::string& name, const std::vector<std::string>& valid) {
  for (const std::string& known : valid)
    if (name == known) return;
  throw Failure(ExitCode::usage,
                "there is no " + kind + " '" + name + "'; " + scene::suggestion(name, valid));
}

void require_case(const std::string& name, const std::vector<Case>& cases) {
  if (std::ranges::find(cases, name, &Case::name) != cases.end()) return;
  std::vector<std::string> names;
  for (const Case& c : cases) names.push_back(c.name);
  throw Failure(ExitCode::usage, "this drogue-perf has no case '" + name + "'" +
                                     (scene::nearest(name, names) ? "; " + scene::suggestion(name, names)
                                                                  : "; see drogue-perf list"));
}

}  // namespace drogue::perf
