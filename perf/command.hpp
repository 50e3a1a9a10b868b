#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "kernels/device/backend.hpp"

namespace drogue::perf {

/// A subcommand of drogue-perf: it declares its options where it is made and keeps them for its run.
struct Command {
  const CLI::App* app;                                               ///< knows whether it was asked for
  std::function<ExitCode(const std::vector<std::string>&)> execute;  ///< takes the --kokkos-* options
};

Command list_command(CLI::App& program);
Command run_command(CLI::App& program);
Command table_command(CLI::App& program);
Command work_precision_command(CLI::App& program);

/// Throws Failure(no_backend) with the reason if `backend` cannot run here. Before Kokkos starts.
void require(device::Backend backend);

/// Throws Failure(usage) with the nearest of `valid` if `name` is none of them.
void require_name(const std::string& what, const std::string& name, const std::vector<std::string>& valid);

}  // namespace drogue::perf
