#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/device/runtime.hpp"
#include "perf/measure/record.hpp"

namespace drogue::perf {

// The functions below print to standard output and block until all samples are measured. They throw what the
// solvers throw.

/// Table 4.1 of [Shi]: its machine beside this one. The record has no samples; its facts are those printed.
/// Call it with an initialised runtime.
Table print_machine(const device::DeviceFacts& device);

/// Table 4.2 of [Shi] by the occupancy model, the occupancy of the step kernels of gas on `architecture`,
/// such as "sm_90", and all kernels of `profile`, a file or folder for `read_profiles`, beside the model;
/// empty: none. The records have no samples; their error is the number of mismatches. Throws as
/// `read_profiles`, and Failure(usage) for an unknown architecture.
Table print_occupancy(const std::string& architecture, const std::string& profile,
                      const nlohmann::json& provenance);

/// Time and share of each kernel, and of all of an area, in `profile`, a file or folder for `read_profiles`.
/// The records have no samples. Throws as `read_profiles`, and Failure(invalid_scene) without durations.
Table print_kernel_times(const std::string& profile, const nlohmann::json& provenance);

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

/// Part of a machine over which scaling is measured.
enum class ScalingUnit { threads, ranks };

/// "threads" or "ranks". Does not throw.
const char* name(ScalingUnit unit);

/// Scaling of a program.
struct ScalingRequest {
  ScalingUnit unit = ScalingUnit::threads;
  bool weak = false;  ///< the work grows with the units
  int most = 0;       ///< largest number of units; 0: all processors or GPUs
};

/// Strong or weak scaling of steps of flow over threads, or over ranks of mpirun, by runs of
/// drogue-parachute, which stands beside this program. Call it without an initialised runtime. Throws Failure
/// as the program does, interrupted after a signal, and no_backend without mpirun.
Table print_program_scaling(const ScalingRequest& request, const std::vector<device::Backend>& backends,
                            bool quick);

/// Time against block size and mesh for the kernels of `block_forms`, figure 4.4 for gas, beside the
/// occupancy that the model predicts. `backend` must be a GPU. `capability`: its compute capability; an
/// unknown one is replaced by 9.0. `profile`: for `read_profiles`, for registers of the kernels; empty: those
/// of their launch bounds.
Table print_block_sizes(const std::string& app, device::Backend backend, bool quick,
                        const std::string& capability, const std::string& profile,
                        const nlohmann::json& provenance);

/// Cost of Kokkos: times of kernels of gas, springs or flow against the same algorithm written in CUDA, by
/// size. `backend` must be `cuda`.
Table print_abstraction(const std::string& app, device::Backend backend, bool quick,
                        const nlohmann::json& provenance);

}  // namespace drogue::perf
