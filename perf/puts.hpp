#pragma once

#include <map>
#include <string>
#include <vector>

#include "kernels/options/pricer.hpp"

/// American puts of strike 1 that are timed, the prices of some of which are known.
namespace drogue::perf::puts {

/// Distinct ones: the dissertation's law at five spots first, then laws about it.
std::vector<options::Contract> distinct(std::size_t count);

/// The largest error of the known ones among the first of `distinct`.
double error(const std::vector<options::Price>& prices);

/// What the dissertation's own scheme misses at mesh 128, of the strike (reference values of this project).
inline constexpr double bar = 4.4e-4;

/// Seconds of a batch's copies and of what lies between.
std::map<std::string, double> parts(const options::Timing& timing);

}  // namespace drogue::perf::puts
