#include "perf/models/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

#include "common/program/failure.hpp"
#include "common/program/program.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/gas/tile/team_shape.hpp"
#include "perf/profile/kernel_profile.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

nlohmann::json facts_of(const Architecture& on, const Block& block, const Occupancy& o) {
  nlohmann::json facts = {{"architecture", on.name},
                          {"block", block.threads},
                          {"registers", block.registers},
                          {"shared_bytes", block.shared_bytes},
                          {"blocks_by_registers", o.by_registers},
                          {"blocks_by_shared_memory", o.by_shared_memory},
                          {"blocks_by_threads", o.by_threads},
                          {"blocks_by_limit", o.by_limit},
                          {"blocks", o.blocks},
                          {"threads_sm", o.threads},
                          {"occupancy", o.occupancy}};
  if (on.multiprocessors > 0) facts["threads_device"] = o.device_threads;
  return facts;
}

/// Record without samples; its error is the number of mismatches.
Record untimed(const Architecture& on, const std::string& kernel, int mismatches) {
  return {.name = "occupancy/" + std::string(on.name) + "/" + kernel,
          .unit_of_work = "step",
          .bound = "what a multiprocessor holds",
          .error = static_cast<double>(mismatches)};
}

/// Entries of a printed row, and how many of them differ from the model.
struct PrintedRow {
  nlohmann::json facts;
  int mismatches = 0;
};

PrintedRow compare_with_printed(const dissertation::OccupancyRow& printed, const Block& block,
                                const Occupancy& o) {
  const bool same_percent = std::round(1000.0 * o.occupancy) == std::round(10.0 * printed.percent);
  PrintedRow row{{{"occupancy_percent", printed.percent}}, same_percent ? 0 : 1};
  for (const auto& [key, ours, theirs] :
       {std::tuple{"shared_bytes", block.shared_bytes, printed.shared_bytes},
        {"blocks_by_registers", o.by_registers, printed.by_registers},
        {"blocks_by_shared_memory", o.by_shared_memory, printed.by_shared_memory},
        {"blocks_by_limit", o.by_limit, printed.by_limit},
        {"blocks", o.blocks, printed.blocks},
        {"threads_sm", o.threads, printed.threads},
        {"threads_device", o.device_threads, printed.device_threads}}) {
    row.facts[key] = theirs;
    row.mismatches += ours == theirs ? 0 : 1;
  }
  return row;
}

void print_table_4_2(Table& table, const nlohmann::json& provenance) {
  const Architecture on = fermi();
  std::printf(
      "Table 4.2: the flux kernel of [Shi] on compute capability 2.0, %d registers per thread;\n"
      "computed (printed)\n\n"
      "block  shared bytes    by registers  by shared  by limit  blocks  threads/SM  threads/device    %% "
      "of the threads\n",
      dissertation::flux_registers);
  for (const dissertation::OccupancyRow& printed : dissertation::table_4_2) {
    const Block block{printed.block, dissertation::flux_registers,
                      dissertation::flux_shared_bytes(printed.block)};
    const Occupancy o = occupancy(on, block);
    const PrintedRow row = compare_with_printed(printed, block, o);
    const Record record = untimed(on, std::to_string(block.threads), row.mismatches);
    std::printf(
        "%5d  %5d (%5d)   %6d (%2d)   %4d (%2d)  %3d (%d)  %3d (%d)   %3d (%3d)     %4d (%4d)     %4.1f "
        "(%4.1f)%s\n",
        block.threads, block.shared_bytes, printed.shared_bytes, o.by_registers, printed.by_registers,
        o.by_shared_memory, printed.by_shared_memory, o.by_limit, printed.by_limit, o.blocks, printed.blocks,
        o.threads, printed.threads, o.device_threads, printed.device_threads, 100.0 * o.occupancy,
        printed.percent, record.passed() ? "" : "  FAILED");
    nlohmann::json facts = facts_of(on, block, o);
    facts["thesis"] = row.facts;
    table.add(record, provenance, facts);
  }
  std::printf(
      "\nCorrected slips of [Shi], section 4.3: shared memory limits blocks, not threads; its quotient is "
      "rounded "
      "down in the\nminimum of all limits; and that includes the 48 warps of a multiprocessor\n");
}

/// Launch configuration of a step kernel.
struct StepKernel {
  int team, slots;
  int registers;    ///< largest number per thread under the launch bounds
  int least_teams;  ///< resident teams that the launch bounds require
  const char* name;
};

std::vector<StepKernel> step_kernels() {
  std::vector<StepKernel> kernels;
  for (const int team : {32, 64, 96, 128, 192, 256, 384, 512}) {
    const bool small = team <= gas::default_team;
    kernels.push_back({.team = team,
                       .slots = gas::fitting_slots(gas::device_rows, team, team),
                       .registers = small ? 168 : 128,
                       .least_teams = small ? gas::default_teams : gas::largest_teams,
                       .name = ""});
  }
  kernels.push_back({.team = gas::default_team,
                     .slots = gas::largest_tile,
                     .registers = 128,
                     .least_teams = gas::dense_teams,
                     .name = "/large-mesh"});
  return kernels;
}

/// Threads of a device; empty if its number of multiprocessors is unknown.
std::string device_threads(const Architecture& on, const Occupancy& o) {
  return on.multiprocessors > 0 ? std::to_string(o.device_threads) : "";
}

/// `on` is hopper(), for which the launch bounds are chosen, or an architecture of no device in particular,
/// where fewer blocks than they request are stated and no fault.
void print_step_kernels(Table& table, const Architecture& on, const nlohmann::json& provenance) {
  const bool is_tuned = on.multiprocessors > 0;
  const std::string device = is_tuned ? std::to_string(on.multiprocessors) + " multiprocessors"
                                      : "number of multiprocessors unknown";
  std::printf(
      "\nThe fused step of drogue-gas on %s, %s; the last row is that of %lld cells and more\n\n"
      "block  slots  registers  shared bytes  by registers  by shared  by threads  by limit  blocks  "
      "threads/SM%s    %% of the threads\n",
      on.name.data(), device.c_str(), static_cast<long long>(gas::large_mesh),
      is_tuned ? "  threads/device" : "");
  for (const StepKernel& kernel : step_kernels()) {
    const Block block{kernel.team, kernel.registers,
                      gas::shared_bytes(gas::device_rows, kernel.slots, kernel.team)};
    const Occupancy o = occupancy(on, block);
    const int missing = std::max(0, kernel.least_teams - o.blocks);
    const Record record =
        untimed(on, std::to_string(block.threads) + kernel.name + (is_tuned ? "" : "/gas-step"),
                is_tuned ? missing : 0);
    const std::string shortage =
        missing > 0 ? "  launch bounds request " + std::to_string(kernel.least_teams) + " blocks" : "";
    std::printf("%5d  %5d  %9d  %12d  %12d  %9d  %10d  %8d  %6d  %10d%*s  %5.1f%s%s\n", block.threads,
                kernel.slots, block.registers, block.shared_bytes, o.by_registers, o.by_shared_memory,
                o.by_threads, o.by_limit, o.blocks, o.threads, is_tuned ? 16 : 0,
                device_threads(on, o).c_str(), 100.0 * o.occupancy, shortage.c_str(),
                record.passed() ? "" : "  FAILED");
    nlohmann::json facts = facts_of(on, block, o);
    facts["slots"] = kernel.slots;
    facts["least_blocks"] = kernel.least_teams;
    table.add(record, provenance, facts);
  }
}

/// Architecture of a profiled device. Throws Failure(invalid_scene).
Architecture architecture_of(const KernelProfile& kernel) {
  const Architecture* known = find_architecture(kernel.capability);
  if (known == nullptr)
    throw Failure(ExitCode::invalid_scene,
                  kernel.place + ": the model of occupancy has no compute capability '" + kernel.capability +
                      "'; its last one is " + std::string(architectures().back().name));
  Architecture on = *known;
  on.multiprocessors = kernel.multiprocessors;
  return on;
}

/// Kernel of a profile beside the model.
struct ProfiledKernel {
  Architecture on;
  Block block;
  Occupancy predicted;
  int achieved;      ///< resident blocks that ncu finds possible for this launch
  double mean;       ///< resident blocks by counters; NaN: not measured
  std::string name;  ///< label without the namespace of the project
  int mismatches;    ///< blocks of difference, and 1 if more were resident than predicted
};

/// The counters of warps and of cycles are read one after the other.
constexpr double counter_tolerance = 0.02;

ProfiledKernel compare_with_model(const KernelProfile& kernel) {
  ProfiledKernel k{.on = architecture_of(kernel),
                   .block = {kernel.threads, kernel.registers, kernel.shared_bytes},
                   .predicted = {},
                   .achieved = std::min(
                       {kernel.by_registers, kernel.by_shared_memory, kernel.by_threads, kernel.by_limit}),
                   .mean = 0.0,
                   .name = kernel.name(),
                   .mismatches = 0};
  k.predicted = occupancy(k.on, k.block, kernel.carve_out);
  const int warps = (kernel.threads + 31) / 32;
  k.mean = kernel.active_fraction * k.on.threads / (32.0 * warps);
  const bool exceeds = k.mean > (1.0 + counter_tolerance) * k.predicted.blocks;
  k.mismatches = std::abs(k.achieved - k.predicted.blocks) + (exceeds ? 1 : 0);
  return k;
}

nlohmann::json profiled_facts(const KernelProfile& kernel, const ProfiledKernel& k) {
  nlohmann::json facts = facts_of(k.on, k.block, k.predicted);
  facts["kernel"] = kernel.kernel;
  facts["limited_by"] = limits_of(k.predicted);
  facts["launches"] = kernel.launches;
  facts["achieved"] = {{"blocks_by_registers", kernel.by_registers},
                       {"blocks_by_shared_memory", kernel.by_shared_memory},
                       {"blocks_by_threads", kernel.by_threads},
                       {"blocks_by_limit", kernel.by_limit},
                       {"blocks", k.achieved}};
  if (!kernel.device.empty()) facts["device"] = kernel.device;
  if (kernel.carve_out > 0) facts["carve_out_bytes"] = kernel.carve_out;
  if (kernel.grid > 0.0) facts["grid"] = kernel.grid;
  if (!std::isnan(k.mean)) facts["achieved"]["mean_blocks"] = k.mean;
  return facts;
}

/// States all four limits where the least ones differ.
void print_difference(const KernelProfile& kernel, const ProfiledKernel& k) {
  const Occupancy& o = k.predicted;
  std::printf(
      "    %s: blocks by registers %d (ncu %d), shared memory %d (%d) of %d bytes, threads %d (%d), limit %d "
      "(%d)\n",
      kernel.place.c_str(), o.by_registers, kernel.by_registers, o.by_shared_memory, kernel.by_shared_memory,
      kernel.carve_out > 0 ? kernel.carve_out : k.on.shared_bytes, o.by_threads, kernel.by_threads,
      o.by_limit, kernel.by_limit);
}

Failure unknown_architecture(const std::string& name) {
  std::vector<std::string> valid;
  for (const Architecture& known : architectures()) valid.emplace_back(known.name);
  return {ExitCode::usage, "there is no architecture '" + name + "'; " + scene::suggestion(name, valid)};
}

/// Names the areas of which no kernel was profiled.
void print_missing(const std::vector<KernelProfile>& kernels) {
  std::string missing;
  for (const char* area : {"gas", "fabric", "options", "flow", "linear", "coupling"})
    if (std::ranges::none_of(kernels, [&](const KernelProfile& k) {
          return k.kernel.starts_with("drogue::" + std::string(area) + "::");
        }))
      missing += (missing.empty() ? "" : ", ") + std::string(area);
  if (!missing.empty()) std::printf("The profile has no kernel of %s.\n", missing.c_str());
}

/// "sm_90 with 132 multiprocessors", after the name of the device if it is known.
std::string device_of(const Architecture& on, const std::string& name = "") {
  return (name.empty() ? "" : name + ", ") + std::string(on.name) +
         (on.multiprocessors > 0 ? " with " + std::to_string(on.multiprocessors) + " multiprocessors" : "");
}

/// Names the devices on which the kernels were profiled.
void print_devices(const std::vector<KernelProfile>& kernels) {
  std::set<std::string> devices;
  for (const KernelProfile& kernel : kernels)
    devices.insert(device_of(architecture_of(kernel), kernel.device));
  for (const std::string& device : devices) std::printf("Profiled on %s.\n", device.c_str());
}

/// States which kernels are of another device than `wanted`; they are predicted for their own.
void print_other_devices(const Architecture& wanted, const std::vector<KernelProfile>& kernels) {
  std::map<std::string, int> others;
  for (const KernelProfile& kernel : kernels) {
    const Architecture on = architecture_of(kernel);
    const bool both_known = on.multiprocessors > 0 && wanted.multiprocessors > 0;
    if (on.name != wanted.name || (both_known && on.multiprocessors != wanted.multiprocessors))
      ++others[device_of(on, kernel.device)];
  }
  for (const auto& [device, count] : others)
    std::printf(
        "%d of %zu kernels were profiled on another device than %s: on %s, for which they are predicted.\n",
        count, kernels.size(), device_of(wanted).c_str(), device.c_str());
}

void print_profile(Table& table, const Architecture& wanted, const std::string& path,
                   const std::vector<KernelProfile>& kernels, const nlohmann::json& provenance) {
  std::printf(
      "\nKernels of %s: blocks that a multiprocessor holds, predicted from\nregisters, shared memory and "
      "block; "
      "achieved, by ncu's limits of the launch; and their mean while the\nmultiprocessors worked\n\n"
      "%-44s %6s %6s %9s %12s %9s %8s %6s %6s  %s\n",
      path.c_str(), "kernel", "device", "block", "registers", "shared bytes", "predicted", "achieved", "mean",
      "%", "limited by");
  std::size_t right = 0;
  for (const KernelProfile& kernel : kernels) {
    const ProfiledKernel k = compare_with_model(kernel);
    std::string name = k.name;
    for (const int part : {kernel.threads, kernel.registers, kernel.shared_bytes})
      name += "/" + std::to_string(part);
    if (kernel.carve_out > 0) name += "/" + std::to_string(kernel.carve_out);
    const Record record = untimed(k.on, name, k.mismatches);
    std::printf("%-44s %6s %6d %9d %12d %9d %8d %6.2f %6.1f  %s%s\n", k.name.c_str(), k.on.name.data(),
                kernel.threads, kernel.registers, kernel.shared_bytes, k.predicted.blocks, k.achieved, k.mean,
                100.0 * k.predicted.occupancy, limits_of(k.predicted).c_str(),
                record.passed() ? "" : "  FAILED");
    if (record.passed())
      ++right;
    else
      print_difference(kernel, k);
    table.add(record, provenance, profiled_facts(kernel, k));
  }
  std::printf("\n%zu of %zu kernels are predicted to the block.\n", right, kernels.size());
  print_devices(kernels);
  print_other_devices(wanted, kernels);
  print_missing(kernels);
  if (right != kernels.size())
    print_notice("drogue-perf",
                 std::to_string(kernels.size() - right) +
                     " kernels of the profile contradict the model; their rows are marked FAILED");
}

}  // namespace

Table print_occupancy(const std::string& architecture, const std::string& profile,
                      const nlohmann::json& provenance) {
  const Architecture* known = find_architecture(architecture);
  if (known == nullptr) throw unknown_architecture(architecture);
  const Architecture on = known->name == hopper().name ? hopper() : *known;
  const std::vector<KernelProfile> kernels =
      profile.empty() ? std::vector<KernelProfile>{} : read_profiles(profile);
  Table table;
  print_table_4_2(table, provenance);
  print_step_kernels(table, on, provenance);
  if (profile.empty())
    std::printf(
        "\nAchieved blocks need CUDA: scripts/profile_occupancy.sh profiles the kernels of all mini-apps on "
        "a GPU "
        "by ncu,\nand --profile reads its files here.\n");
  else
    print_profile(table, on, profile, kernels, provenance);
  return table;
}

}  // namespace drogue::perf
