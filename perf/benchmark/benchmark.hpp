#pragma once

#include <filesystem>
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
  bool weak = false;  ///< the flow alone, on 1, 2, 4, ... ranks with equal cells on each
  int ranks = 1;      ///< of flow
  int threads = 0;    ///< of a rank; 0: those of OMP_NUM_THREADS, or a share of the processors
  std::vector<std::string> launcher;  ///< words that start `{ranks}` ranks; empty: those of mpirun
  std::filesystem::path folder;       ///< in which the programs run
};

/// A problem on some ranks.
struct Row {
  Problem problem;
  int ranks;
  std::string name;  ///< of its files in the folder, which no other row has
};

/// All rows of a request, in the order of the table. Throws only std::bad_alloc.
[[nodiscard]] std::vector<Row> rows(const Request& request);

/// Runs the rows by the programs, which stand beside this one, checks their answers, prints a line for each
/// and then the commands, and adds the records to `table`. Call it without an initialised runtime. Throws
/// Failure(io_error) before all runs if a program is missing; after all runs, as the first program that left
/// no result, whose row has the reason; Failure(interrupted) after a signal. A wrong result throws nothing:
/// its row failed.
void run(const Request& request, const std::vector<Row>& rows, Table& table);

}  // namespace drogue::perf::benchmark
