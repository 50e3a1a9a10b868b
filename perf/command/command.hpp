#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "kernels/device/backend.hpp"
#include "perf/measure/measurement.hpp"

namespace drogue::perf {

/// Subcommand of drogue-perf. Its maker declares the options; `execute` uses their parsed values.
struct Command {
  const CLI::App* app;                                               ///< its parser
  std::function<ExitCode(const std::vector<std::string>&)> execute;  ///< argument: --kokkos-* options
};

/// Subcommands; each registers itself with `program`. Throws CLI::Error if its name is taken.
Command list_command(CLI::App& program);
Command benchmark_command(CLI::App& program);
Command run_command(CLI::App& program);
Command table_command(CLI::App& program);
Command work_precision_command(CLI::App& program);
Command compare_command(CLI::App& program);
Command report_command(CLI::App& program);
Command ladder_command(CLI::App& program);
Command ncu_command(CLI::App& program);
Command messages_command(CLI::App& program);
Command extrapolate_command(CLI::App& program);

/// The backend of a name, or with `auto` all that are present. Throws Failure(no_backend) with the reason if
/// the named one cannot run here. Call it before Kokkos is initialised.
std::vector<device::Backend> backends_of(const std::string& name);

/// Code of a finished measurement. After a signal, prints a notice and returns `interrupted`.
ExitCode code_of(bool passed);

/// Throws Failure(no_backend) with the reason if `backend` cannot run here. Call it before Kokkos is
/// initialised.
void require(device::Backend backend);

/// Description of an option --app, with its valid names. Does not throw.
std::string app_help(const std::string& purpose);

/// Throws Failure(usage) with the nearest valid name if `app` is not a name for --app.
void require_app(const std::string& app);

/// Throws Failure(usage) with the nearest valid name if `name`, the name of a `kind`, is not in `valid`.
void require_name(const std::string& kind, const std::string& name, const std::vector<std::string>& valid);

/// Throws Failure(usage) with the nearest name if no case is called `name`.
void require_case(const std::string& name, const std::vector<Case>& cases);

/// Regular expression of the option --filter. Throws Failure(usage) for a malformed or an overlong text.
std::regex filter_of(const std::string& text);

/// Reason why a backend that a filter or the name of a case names between slashes cannot run here. Does not
/// throw.
std::optional<std::string> missing_backend(const std::string& filter);

}  // namespace drogue::perf
