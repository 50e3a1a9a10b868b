#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kernels/options/contract.hpp"

namespace drogue::options_app {

/// Parameter of a family.
struct FamilyParameter {
  const char* name;
  bool required = true;
  double usual = 0.0;  ///< value if it is not required and not given
};

/// Distribution of the log returns over one period, or of the increments of a process over it, in parameters
/// other than those of a batch.
struct ParameterFamily {
  const char* name;
  std::vector<FamilyParameter> parameters;
  /// Generalized hyperbolic lambda, alpha, beta, delta of the period from the parameters, in their order. The
  /// location is dropped: the drift of a batch follows from rate and dividend.
  void (*convert)(const double* parameters, double* jump);
  /// Condition that the parameters violate, as a clause, or an empty text.
  std::string_view (*violated)(const double* parameters);
};

/// variance-gamma: sigma, nu, theta (Madan, Carr and Chang 1998). nig: alpha, beta, delta, mu
/// (Barndorff-Nielsen 1997). genhyperbolic: p, a, b, loc, scale of scipy.stats.genhyperbolic.
[[nodiscard]] const std::vector<ParameterFamily>& parameter_families();

/// Multiplies the Levy density by `periods`: the law of as many periods. Only variance gamma (delta = 0) and
/// normal inverse Gaussian (lambda = -1/2) laws keep their form; returns false for the others.
[[nodiscard]] bool scale_periods(double* jump, double periods);

}  // namespace drogue::options_app
