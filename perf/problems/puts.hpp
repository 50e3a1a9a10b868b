#pragma once

#include <string>

#include "kernels/options/pricer.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/memory/memory.hpp"

/// Batches and surfaces of American puts, some of which have known prices. No function throws before a case
/// runs.
namespace drogue::perf::puts {

/// Tolerance of finite differences, relative to the strike: four to five times the largest error of their
/// batches and surfaces on that mesh (docs/evidence/options-h200.jsonl and options-transfers-h100.jsonl;
/// options/serial/16/64x16 for the coarsest mesh).
constexpr double tolerance(int mesh) {
  if (mesh < 128) return 2e-4;
  if (mesh < 256) return 3e-5;
  if (mesh < 512) return 9e-6;
  return mesh < 1024 ? 1.3e-6 : 1.5e-7;
}

/// Largest error of cosine series with a tolerance of 1e-3: five times that of
/// docs/evidence/options-cos-h100.jsonl.
inline constexpr double loose_cosine_error = 1.5e-5;

/// Distinct puts of strike 1: first those of `thesis_puts`, then random ones with similar parameters, the
/// same on every machine. Throws only std::bad_alloc.
std::vector<options::Contract> distinct(std::size_t count);

/// Prices `count` puts of `distinct`. Contracts and prices stand in `memory`. A sample is the sum of copies
/// and compute; the error is the largest of the known prices.
Case batch(const std::string& name, device::Backend backend, HostMemory memory, std::size_t count,
           const options::Settings& settings, double limit);

/// Numbers of parameter sets, of strikes from half to twice the spot, and of maturities from a quarter to two
/// years.
struct SurfaceSize {
  std::size_t sets, strikes, maturities;
};

/// Prices surfaces of puts, ordered by set, maturity and strike: first the parameter set of `thesis_puts`,
/// then random similar ones. A sample is the sum of copies and compute; the error is that of the known
/// prices.
Case surface(const std::string& name, device::Backend backend, const SurfaceSize& size,
             const options::Settings& settings, double limit);

}  // namespace drogue::perf::puts
