#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <memory>

#include "perf/command/command.hpp"
#include "perf/models/messages.hpp"
#include "perf/models/scaling.hpp"
#include "perf/rows/printed.hpp"

namespace drogue::perf {
namespace {

struct ExtrapolateOptions {
  std::vector<int> cells = {512, 512, 512}, ranks = {1, 2, 4, 8};
  bool weak = false;
  double fixed_us = 0.0, cell_ns = 0.0;
  std::vector<double> in_node, between_nodes;  ///< us and GB/s
  int ranks_per_node = 8;
};

Link link_of(const std::vector<double>& us_and_gigabytes) {
  return {1e-6 * us_and_gigabytes[0], 1e9 * us_and_gigabytes[1]};
}

ExitCode print_extrapolation(const ExtrapolateOptions& options) {
  const FlowMachine machine{
      .fixed_time = 1e-6 * options.fixed_us,
      .time_per_cell = 1e-9 * options.cell_ns,
      .in_node = link_of(options.in_node),
      .between_nodes = link_of(options.between_nodes.empty() ? options.in_node : options.between_nodes),
      .ranks_per_node = options.ranks_per_node};
  const std::array<int, 3> one = {options.cells[0], options.cells[1], options.cells[2]};
  const double of_one = estimate_step(machine, one, 1).total();
  std::printf("%6s %16s %11s %11s %11s %11s %11s %9s %11s\n", "ranks", "cells", "compute ms", "ghosts ms",
              "gather ms", "agree ms", "step ms", "speed-up", "efficiency");
  for (const int ranks : options.ranks) {
    const std::array<int, 3> cells = scaled_cells(one, options.weak, ranks);
    const std::string grid = printed("%dx%dx%d", cells[0], cells[1], cells[2]);
    if (cells[2] / ranks < least_planes && ranks > 1) {
      std::printf("%6d %16s  each rank needs %d planes\n", ranks, grid.c_str(), least_planes);
      continue;
    }
    const StepEstimate step = estimate_step(machine, cells, ranks);
    const double share = efficiency(options.weak, of_one, step.total(), ranks);
    std::printf("%6d %16s %11.3f %11.3f %11.3f %11.3f %11.3f %8.2fx %9.0f %%\n", ranks, grid.c_str(),
                1e3 * step.compute, 1e3 * step.ghosts, 1e3 * step.gather, 1e3 * step.agreement,
                1e3 * step.total(), share * ranks, 100.0 * share);
  }
  return ExitCode::ok;
}

}  // namespace

Command extrapolate_command(CLI::App& program) {
  const auto options = std::make_shared<ExtrapolateOptions>();
  CLI::App* app = program.add_subcommand(
      "extrapolate", "Time of a step of flow in slabs on more ranks than there are, by a model of messages");
  app->add_option("--cells", options->cells, "Cells of the box; with --weak of each rank")
      ->expected(3)
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  app->add_option("--ranks", options->ranks, "Numbers of ranks")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app->add_flag("--weak", options->weak, "The box grows along z with the ranks");
  app->add_option("--fixed-us", options->fixed_us,
                  "Part of a step on one rank that does not depend on its cells, us")
      ->check(CLI::NonNegativeNumber)
      ->required();
  app->add_option("--cell-ns", options->cell_ns, "Time per cell of a step on one rank, ns")
      ->check(CLI::PositiveNumber)
      ->required();
  app->add_option("--link", options->in_node,
                  "Latency of a round of messages within a node, us, and GB/s from a rank")
      ->expected(2)
      ->check(CLI::PositiveNumber)
      ->required();
  app->add_option("--network", options->between_nodes, "The same between nodes; that within a node")
      ->expected(2)
      ->check(CLI::PositiveNumber);
  app->add_option("--per-node", options->ranks_per_node, "Ranks of a node")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  return {app,
          [options](const std::vector<std::string>& /*kokkos*/) { return print_extrapolation(*options); }};
}

}  // namespace drogue::perf
