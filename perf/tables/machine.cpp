#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "common/program/provenance.hpp"
#include "kernels/device/gpu_hardware.hpp"
#include "kernels/device/host_cores.hpp"
#include "perf/caches/host_caches.hpp"
#include "perf/measure/record.hpp"
#include "perf/rows/printed.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// Value of sysconf(3), 0 for an unknown one.
std::int64_t system_fact(int name) { return std::max<std::int64_t>(0, sysconf(name)); }

/// First value of `key` in a file of lines `key<separator>value`, without quotation marks; empty if absent.
std::string value_in(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t end = line.find(separator);
    if (!line.starts_with(key) || end == std::string::npos) continue;
    std::string value = line.substr(end + 1);
    std::erase(value, '"');
    return value.substr(std::min(value.size(), value.find_first_not_of(' ')));
  }
  return "";
}

/// Clock of the first core at this moment, Hz; 0 if the system does not state it.
double host_clock() {
  const std::string mhz = value_in("/proc/cpuinfo", "cpu MHz", ':');
  return mhz.empty() ? 0.0 : 1e6 * std::stod(mhz);
}

/// `value` over `unit` with the name of the unit; "not stated" for 0.
std::string amount(double value, double unit, const char* name) {
  return value == 0.0 ? "not stated" : printed("%.4g %s", value / unit, name);
}

std::string bytes(double value) {
  constexpr double kib = 1024.0, mib = kib * kib, gib = kib * mib;
  return value >= gib   ? amount(value, gib, "GiB")
         : value >= mib ? amount(value, mib, "MiB")
                        : amount(value, kib, "KiB");
}

std::string bytes(const nlohmann::json& facts, const char* key) { return bytes(facts.at(key).get<double>()); }

/// Caches of all levels as [Shi] writes them, "L1 16 x 32 KiB, ..."; "not stated" for unknown ones.
std::string cache_text() {
  std::string text;
  for (const int level : {1, 2, 3}) {
    std::string sizes;
    for (const auto& [size, count] : host_caches(level))
      sizes +=
          (sizes.empty() ? "" : " + ") + std::to_string(count) + " x " + bytes(static_cast<double>(size));
    text += (level > 1 ? ", L" : "L") + std::to_string(level) + " " + (sizes.empty() ? "not stated" : sizes);
  }
  return text;
}

/// Sum over all caches of a level; null for unknown ones.
nlohmann::json cache_bytes(int level) {
  const std::int64_t sum = host_cache_bytes(level);
  return sum > 0 ? nlohmann::json(sum) : nlohmann::json();
}

nlohmann::json host_facts() {
  utsname system{};
  uname(&system);
  return {{"cpu", cpu_model()},
          {"cores", device::host_cores().online},
          {"clock_hz", host_clock()},
          {"memory_bytes", system_fact(_SC_PHYS_PAGES) * system_fact(_SC_PAGESIZE)},
          {"l1_bytes", cache_bytes(1)},
          {"l2_bytes", cache_bytes(2)},
          {"l3_bytes", cache_bytes(3)},
          {"os", value_in("/etc/os-release", "PRETTY_NAME", '=')},
          {"kernel", std::string(system.sysname) + " " + system.release}};
}

nlohmann::json gpu_facts(const std::string& name) {
  const device::GpuHardware gpu = device::gpu_hardware();
  return {{"gpu", name},
          {"multiprocessors", gpu.multiprocessors},
          {"clock_hz", 1e3 * gpu.clock_khz},
          {"memory_bytes", gpu.memory},
          {"constant_bytes", gpu.constant},
          {"shared_bytes", gpu.shared},
          {"l2_bytes", gpu.l2},
          {"registers", gpu.registers}};
}

nlohmann::json printed_facts() {
  const dissertation::Machine& printed = dissertation::table_4_1;
  return {{"cpu", printed.cpu},
          {"caches", printed.caches},
          {"gpu", printed.gpu},
          {"gpu_memory", printed.gpu_memory},
          {"registers", printed.registers},
          {"os", printed.os},
          {"compiler", printed.compiler},
          {"cuda", printed.cuda}};
}

void print_line(const char* part, const char* printed, const std::string& here) {
  std::printf("%-9s %-58s %s\n", part, printed, here.c_str());
}

}  // namespace

Table print_machine(const device::DeviceFacts& device) {
  const nlohmann::json host = host_facts(), gpu = gpu_facts(device.gpu), here = provenance(device);
  std::printf("Table 4.1: the machine of [Shi], and this one\n\n");
  print_line("CPU", dissertation::table_4_1.cpu,
             host["cpu"].get<std::string>() + ", " + std::to_string(host["cores"].get<int>()) + " cores, " +
                 amount(host["clock_hz"].get<double>(), 1e9, "GHz") + ", " + bytes(host, "memory_bytes"));
  print_line("", dissertation::table_4_1.caches, cache_text());
  if (device.gpu.empty()) {
    print_line("GPU", dissertation::table_4_1.gpu, "none");
  } else {
    print_line("GPU", dissertation::table_4_1.gpu,
               device.gpu + ", " + std::to_string(gpu["multiprocessors"].get<int>()) + " multiprocessors, " +
                   amount(gpu["clock_hz"].get<double>(), 1e9, "GHz"));
    print_line("", dissertation::table_4_1.gpu_memory,
               bytes(gpu, "memory_bytes") + " global, " + bytes(gpu, "constant_bytes") + " constant, " +
                   bytes(gpu, "shared_bytes") + " shared per multiprocessor, L2 " + bytes(gpu, "l2_bytes"));
    print_line("", dissertation::table_4_1.registers,
               std::to_string(gpu["registers"].get<int>()) + " registers per multiprocessor");
  }
  print_line("OS", dissertation::table_4_1.os,
             host["os"].get<std::string>() + ", " + host["kernel"].get<std::string>());
  print_line("compiler", dissertation::table_4_1.compiler, here["compiler"].get<std::string>());
  print_line("CUDA", dissertation::table_4_1.cuda,
             device.driver.empty() ? "none" : "driver " + device.driver);
  Table table;
  table.add(
      {"machine", "machine", "none"}, here,
      {{"host", host}, {"device", device.gpu.empty() ? nlohmann::json() : gpu}, {"thesis", printed_facts()}});
  return table;
}

}  // namespace drogue::perf
