#pragma once

#include <string>

#include "kernels/options/pricer.hpp"
#include "perf/measurement.hpp"

/// American puts of strike 1 that are timed, the prices of some of which are known.
namespace drogue::perf::puts {

/// What the dissertation's own scheme misses at mesh 128, of the strike (reference values of this project).
inline constexpr double tolerance = 4.4e-4;

/// Prices `count` distinct ones: the dissertation's law at five spots first, then laws about it. A sample is
/// the sum of copies and compute; the error is the largest of the known ones.
Case batch(const std::string& name, device::Backend backend, std::size_t count,
           const options::Settings& settings, double limit);

/// The strikes of a surface, from half to twice the spot, at maturities of a quarter to two years.
struct SurfaceSize {
  std::size_t sets, strikes, maturities;
};

/// Prices surfaces of puts, strike after strike of a maturity and a set: of the dissertation's law first,
/// then of laws about it. A sample is the sum of copies and compute; the error is that of the known ones.
Case surface(const std::string& name, device::Backend backend, const SurfaceSize& size,
             const options::Settings& settings, double limit);

}  // namespace drogue::perf::puts
