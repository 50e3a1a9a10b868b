#include "perf/cases/cases.hpp"
#include "perf/models/options_march.hpp"
#include "perf/problems/puts.hpp"

namespace drogue::perf {

namespace {

Case batch_case(device::Backend backend, std::size_t count, int mesh, int steps) {
  const std::string name(device::name(backend)), grid = std::to_string(mesh) + "x" + std::to_string(steps);
  Case batch = puts::batch("options/" + name + "/" + std::to_string(count) + "/" + grid, backend,
                           HostMemory::pinned, count, {.mesh = mesh, .steps = steps}, puts::tolerance(mesh));
  // Scratch memory of an option stays in caches.
  constexpr double bytes = sizeof(options::Contract) + sizeof(options::Price);
  const auto puts = static_cast<std::int64_t>(count);
  batch.facts = {.cells = puts,
                 .variant = grid,
                 .flops = static_cast<double>(puts * options_march_arithmetic(mesh, steps).flops()),
                 .bytes = static_cast<double>(count) * bytes};
  return batch;
}

/// Strikes of one surface share a solve; with `apart` each strike has its own solve, as in a batch.
Case surface_case(device::Backend backend, const puts::SurfaceSize& size, bool apart) {
  const std::string name(device::name(backend));
  const std::string count =
      std::to_string(size.sets) + "x" + std::to_string(size.strikes) + "x" + std::to_string(size.maturities);
  const std::string variant = apart ? "apart" : "surface";
  Case surface = puts::surface("options-surface/" + name + "/" + variant + "/" + count, backend, size,
                               {.mesh = 128, .steps = 32, .surface = !apart, .time_copies = !apart},
                               puts::tolerance(128));
  const auto prices = static_cast<std::int64_t>(size.sets * size.strikes * size.maturities);
  surface.facts = {.cells = prices, .variant = variant + " " + count};
  return surface;
}

/// Bermudan puts by cosine series, to a tolerance that leaves few cosines.
Case cosine_case(device::Backend backend, std::size_t count) {
  constexpr double loose = 1e-3;
  const std::string name(device::name(backend));
  Case batch =
      puts::batch("options-cos/" + name + "/" + std::to_string(count), backend, HostMemory::pinned, count,
                  {.method = options::Method::cos, .tolerance = loose}, puts::loose_cosine_error);
  batch.facts = {.cells = static_cast<std::int64_t>(count), .variant = "cos"};
  return batch;
}

}  // namespace

std::vector<Case> options_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : present_backends()) {
    const bool gpu = backend == device::Backend::cuda;
    const auto add = [&](std::size_t count, int mesh, int steps) {
      cases.push_back(batch_case(backend, count, mesh, steps));
    };
    if (quick) {
      add(16, 64, 16);
      cases.push_back(surface_case(backend, {1, 33, 2}, false));
      continue;
    }
    add(1, 128, 32);
    add(gpu ? 4096 : 256, 128, 32);
    add(gpu ? 4096 : 256, 256, 64);
    if (gpu) add(1'000'000, 128, 32);
    if (gpu) cases.push_back(cosine_case(backend, 256));
    cases.push_back(surface_case(backend, {1, 33, 8}, true));
    cases.push_back(surface_case(backend, {1, 33, 8}, false));
    cases.push_back(surface_case(backend, {1, 1000, 8}, false));
    cases.push_back(surface_case(backend, {gpu ? 512U : 16U, 33, 8}, false));
  }
  return cases;
}

}  // namespace drogue::perf
