#include "kernels/options/surface/strike_range.hpp"

#include <vector>

#include "kernels/options/levy/levy_measure.hpp"

namespace drogue::options {
namespace {

constexpr double range_growth = 4.0, smallest_half_width = 1e-6;

double first_half_width(double deviation) {
  return std::max(std::min(3.0 * deviation, std::max(deviation, 1.0)), smallest_half_width);
}

}  // namespace

StrikeRanges::StrikeRanges(double deviation) : _first(first_half_width(deviation)) {}

std::uint8_t StrikeRanges::index_of(double ratio) {
  const double size = std::max(ratio, 1.0 / ratio);
  std::uint8_t k = 0;
  for (; k + 1 < count; ++k) {
    if (k == _known) _ratio[_known++] = device::portable::exp(half_width(k));
    if (!(size > _ratio[k])) break;
  }
  return k;
}

double StrikeRanges::half_width(int k) const {
  double width = _first;
  for (; k > 0; --k) width *= range_growth;
  return width;
}

bool differ_only_in_strike(const Contract& a, const Contract& b) {
  return have_same_process(a, b) && a.style == b.style && a.spot == b.spot && a.rate == b.rate &&
         a.dividend == b.dividend && a.maturity == b.maturity;
}

bool have_same_process(const Contract& a, const Contract& b) {
  return a.model == b.model && a.type == b.type && a.variance == b.variance &&
         std::equal(a.jump, a.jump + 4, b.jump);
}

double annual_variance(const Contract& contract, const double* panels, const int* panel_slot) {
  const NormalizedPut put = normalize(contract);
  std::vector<double> memory(2 * Mixture::size + 2 * Mixture::low);
  double* const at = memory.data();
  const LevyMeasure<double> place{.s = at,
                                  .c = at + Mixture::size,
                                  .up = at + 2 * Mixture::size,
                                  .down = at + 2 * Mixture::size + Mixture::low,
                                  .variance = 0.0,
                                  .high = 0.0};
  const LevyMeasure<double> measure = make_levy_measure(SerialThreadGroup<double>{}, pack_puts<double>(&put),
                                                        &put, panels, panel_slot, place);
  return put.variance + measure.variance;
}

}  // namespace drogue::options
