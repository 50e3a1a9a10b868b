#include "kernels/options/surface/strike_range.hpp"

#include <vector>

#include "kernels/options/levy/levy_measure.hpp"

namespace drogue::options {
namespace {

constexpr double reach_growth = 4.0, least_reach = 1e-6;

double first_reach(double deviation) {
  return std::max(std::min(3.0 * deviation, std::max(deviation, 1.0)), least_reach);
}

}  // namespace

Reaches::Reaches(double deviation) : _first(first_reach(deviation)) {}

std::uint8_t Reaches::find(double ratio) {
  const double size = std::max(ratio, 1.0 / ratio);
  std::uint8_t k = 0;
  for (; k + 1 < most; ++k) {
    if (k == _known) _ratio[_known++] = device::portable::exp(reach(k));
    if (!(size > _ratio[k])) break;
  }
  return k;
}

double Reaches::reach(int k) const {
  double reach = _first;
  for (; k > 0; --k) reach *= reach_growth;
  return reach;
}

bool differ_in_strike_alone(const Contract& a, const Contract& b) {
  return have_same_law(a, b) && a.style == b.style && a.spot == b.spot && a.rate == b.rate &&
         a.dividend == b.dividend && a.maturity == b.maturity;
}

bool have_same_law(const Contract& a, const Contract& b) {
  return a.model == b.model && a.type == b.type && a.variance == b.variance &&
         std::equal(a.jump, a.jump + 4, b.jump);
}

double variance_of(const Contract& contract, const double* panels, const int* panel_slot) {
  const NormalizedPut put = normalize(contract);
  std::vector<double> memory(2 * Mixture::size + 2 * Mixture::low);
  double* const at = memory.data();
  const LevyMeasure<double> place{
      at, at + Mixture::size, at + 2 * Mixture::size, at + 2 * Mixture::size + Mixture::low, 0.0, 0.0};
  const LevyMeasure<double> law =
      make_levy_measure(SerialWorkers<double>{}, pack_puts<double>(&put), &put, panels, panel_slot, place);
  return put.variance + law.variance;
}

}  // namespace drogue::options
