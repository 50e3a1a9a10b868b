#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/measure/measurement.hpp"

namespace drogue::perf {

/// Records of a printed table.
struct Table {
  std::vector<nlohmann::json> records;
  bool passed = true;  ///< all records are within their tolerances

  /// Appends a record as JSON. Does not throw.
  void add(const Record& record, const nlohmann::json& provenance, const nlohmann::json& facts);
};

// The functions below print to standard output and block until all samples are measured. They throw what the
// solvers throw.

/// Table 4.2 of [Shi] by the occupancy model, and the occupancy of the step kernels of gas on an sm_90. The
/// records have no samples; their error is the number of mismatches.
Table print_occupancy(const nlohmann::json& provenance);

/// Table 5.5: copy to the device, compute and copy to the host by the baseline solver and by ours, from
/// pageable memory and, on a GPU, pinned memory, as in all tables of transfers.
Table print_gas_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Table 5.6: copy of the state to the device, Runge-Kutta steps and copy to the host, for several numbers of
/// steps.
Table print_fabric_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Tables 5.7 and 5.8: copy of batches of American puts to the device, pricing and copy to the host.
Table print_options_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Copies of the whole state of a parachute and the air around it, and one or more steps between them.
Table print_parachute_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Pressure solvers of flow: time, iterations and residual for each solver and tolerance, kind of sides and
/// grid.
Table print_flow_pressure(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Memory of flow solvers by grid: bytes of all Views, and, on a GPU, by the count of the driver. The records
/// have no samples.
Table print_flow_memory(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Strong scaling: times of the plain cases of `run` for gas, springs, options or flow by size and, on
/// OpenMP, by number of threads, each in a process of its own. Call it without an initialised runtime. Throws
/// Failure as `run` does, and interrupted after a signal.
Table print_scaling(const std::string& app, const std::vector<device::Backend>& backends, bool quick);

/// Figure 4.4: time per step against block size and mesh, for the baseline solver and for the fused step.
/// `backend` must be a GPU.
Table print_block_sizes(device::Backend backend, bool quick, const nlohmann::json& provenance);

}  // namespace drogue::perf
