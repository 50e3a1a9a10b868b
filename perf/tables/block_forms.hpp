#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/models/occupancy.hpp"

namespace drogue::perf {

/// Kernel with a block size that parameters select, and the work in which it is timed.
struct BlockForm {
  std::string records;  ///< first part of the names of its cases: "gas-block"
  std::string name;     ///< second part after the backend: "seed"
  std::string title;    ///< of its table
  std::string unit;     ///< of the times: "step"
  std::string kernel;   ///< label in a profile: "drogue::gas::StepFunctor"
  std::vector<int> blocks;
  std::vector<std::int64_t> cells;  ///< of the meshes, or options
  /// Case of a mesh, the index of its number of cells, and a block.
  std::function<Case(const std::string& case_name, std::size_t mesh, int block)> make;
  /// Block with the registers that the launch bounds allow, or a launch of the largest block.
  std::function<Block(int block)> resources;
  int most_blocks = 0;  ///< on a multiprocessor, by the launch; 0: as many as fit
};

/// Kernels of `app` with a block size: of gas, options, flow and parachute. Springs have none. Does not
/// throw.
std::vector<BlockForm> block_forms(const std::string& app, device::Backend backend, bool quick);

}  // namespace drogue::perf
