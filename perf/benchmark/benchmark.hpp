#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/benchmark/problems.hpp"
#include "perf/measure/record.hpp"

namespace drogue::perf::benchmark {

/// Runs that are asked for.
struct Request {
  Size size = Size::small;
  device::Backend backend{};
  bool weak = false;                  ///< the flow alone, on 1, 2, 4, ... ranks with equal cells on each
  int ranks = 1;                      ///< of flow
  int threads = 0;                    ///< of a rank; 0: with OpenMP its share of the processors, else 1
  std::vector<std::string> launcher;  ///< words that start `{ranks}` ranks; empty: those of mpirun
  std::filesystem::path folder;       ///< in which the programs run
  std::function<bool(const std::string&)> wants;  ///< whether a problem is run, by its name
};

/// Runs the problems by the programs, which stand beside this one, checks their answers, prints a row for
/// each and then the commands, and adds the records to `table`. Call it without an initialised runtime.
/// Throws Failure as a program does, but for one that computed a wrong result: its row failed. Throws
/// Failure(interrupted) after a signal.
void run(const Request& request, Table& table);

}  // namespace drogue::perf::benchmark
