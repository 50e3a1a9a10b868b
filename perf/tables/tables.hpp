#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/measurement.hpp"

namespace drogue::perf {

/// What a table leaves behind once it is printed.
struct Table {
  std::vector<nlohmann::json> records;
  bool passed = true;

  void add(const Record& record, const nlohmann::json& provenance, const nlohmann::json& facts);
};

/// Table 4.2 by our own model, and the same question for the step kernels of gas on an sm_90. Its records
/// have no samples; their error counts what is not as it should be.
Table print_occupancy(const nlohmann::json& provenance);

/// Table 5.5: host to device, compute, device to host in seed mode, from pageable and, where the backend has
/// such, pinned memory.
Table print_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Table 5.6: the state to the device, some steps of Runge and Kutta, and back, for several numbers of steps.
Table print_fabric_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Tables 5.7 and 5.8: batches of American puts to the device, their prices, and back.
Table print_options_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance);

/// Figure 4.4: time a step for block sizes and meshes, of the seed kernel and of the fused step. `backend` is
/// a device.
Table print_block_sizes(device::Backend backend, bool quick, const nlohmann::json& provenance);

}  // namespace drogue::perf
