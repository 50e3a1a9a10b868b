#pragma once

#include <vector>

#include "perf/measure/measurement.hpp"

/// Benchmark cases that this build and machine can run; `quick` selects small ones. No function throws.
namespace drogue::perf {

/// Backends of the build that can run here, slowest first.
std::vector<device::Backend> present_backends();

/// Change of the standard parameters of a case.
template <class Parameters>
struct Variant {
  const char* name;  ///< last part of the case's name
  void (*apply)(Parameters&);
};

std::vector<Case> gas_cases(bool quick);
std::vector<Case> fabric_cases(bool quick);
std::vector<Case> contact_cases(bool quick);
std::vector<Case> options_cases(bool quick);
std::vector<Case> flow_cases(bool quick);
std::vector<Case> parachute_cases(bool quick);
std::vector<Case> tridiagonal_cases(bool quick);
std::vector<Case> ceiling_cases();

/// All of them, in this order.
std::vector<Case> all_cases(bool quick);

}  // namespace drogue::perf
