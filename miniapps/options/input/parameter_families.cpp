#include "miniapps/options/input/parameter_families.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::options_app {
namespace {

/// The exponent of a year, -ln(1 - i u theta nu + sigma^2 nu u^2/2)/nu, equals lambda ln(gamma^2/(gamma^2 - 2
/// i beta u + u^2)) with gamma^2 = alpha^2 - beta^2.
void from_variance_gamma(const double* p, double* jump) {
  const double sigma = p[0], nu = p[1], theta = p[2], variance = sigma * sigma;
  const double beta = theta / variance;
  jump[0] = 1.0 / nu;
  jump[1] = std::hypot(beta, std::sqrt(2.0 / (variance * nu)));
  jump[2] = beta;
  jump[3] = 0.0;
}

void from_nig(const double* p, double* jump) {
  jump[0] = -0.5;
  std::copy_n(p, 3, jump + 1);
}

void from_genhyperbolic(const double* p, double* jump) {
  const double scale = p[4];
  jump[0] = p[0];
  jump[1] = p[1] / scale;
  jump[2] = p[2] / scale;
  jump[3] = scale;
}

std::string_view violated_of_variance_gamma(const double* p) {
  return !(p[0] > 0.0) ? "sigma must be > 0" : !(p[1] > 0.0) ? "nu must be > 0" : std::string_view();
}

std::string_view violated_of_nig(const double* p) {
  return !(p[2] > 0.0) ? "delta must be > 0" : std::string_view();
}

std::string_view violated_of_genhyperbolic(const double* p) {
  return !(p[4] > 0.0) ? "scale must be > 0" : std::string_view();
}

}  // namespace

const std::vector<ParameterFamily>& parameter_families() {
  static const std::vector<ParameterFamily> families = {
      {"variance-gamma", {{"sigma"}, {"nu"}, {"theta"}}, from_variance_gamma, violated_of_variance_gamma},
      {"nig", {{"alpha"}, {"beta"}, {"delta"}, {"mu", false}}, from_nig, violated_of_nig},
      {"genhyperbolic",
       {{"p"}, {"a"}, {"b"}, {"loc", false}, {"scale", false, 1.0}},
       from_genhyperbolic,
       violated_of_genhyperbolic},
  };
  return families;
}

bool scale_periods(double* jump, double periods) {
  if (jump[3] == 0.0) {
    jump[0] *= periods;
  } else if (jump[0] == -0.5) {
    jump[3] *= periods;
  } else {
    return periods == 1.0;
  }
  return true;
}

}  // namespace drogue::options_app
