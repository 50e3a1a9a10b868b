#include "perf/command/command.hpp"

#include <algorithm>
#include <string_view>

#include "common/program/failure.hpp"
#include "common/program/program.hpp"
#include "common/program/signals.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/device/backend.hpp"
#include "perf/cases/cases.hpp"

namespace drogue::perf {

void require(device::Backend backend) {
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
}

std::vector<device::Backend> backends_of(const std::string& name) {
  const device::Backend wanted = device::wanted_backend(name);
  require(wanted);
  if (name != "auto") return {wanted};
  return present_backends();
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

std::regex filter_of(const std::string& text) {
  // std::regex recurses for nested brackets: a bound on the length bounds the stack.
  constexpr std::size_t longest = 1000;
  if (text.size() > longest)
    throw Failure(ExitCode::usage, "--filter has more than " + std::to_string(longest) + " characters");
  try {
    return std::regex(text);
  } catch (const std::regex_error&) {
    throw Failure(ExitCode::usage,
                  "--filter '" + text +
                      "' is not a valid regular expression; literal brackets and stars need a "
                      "backslash before them");
  }
}

std::optional<std::string> missing_backend(const std::string& filter) {
  constexpr std::string_view separators = "/^$|()";
  for (std::size_t begin = 0; begin < filter.size();) {
    const std::size_t end = std::min(filter.find_first_of(separators, begin), filter.size());
    if (const auto backend = device::backend_from_name(filter.substr(begin, end - begin)))
      if (const auto reason = device::why_unavailable(*backend)) return reason;
    begin = end + 1;
  }
  return {};
}

}  // namespace drogue::perf
