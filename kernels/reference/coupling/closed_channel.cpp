#include "kernels/reference/coupling/closed_channel.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {

ClosedChannelStep closed_channel_step(double velocity, double acceleration, double mass,
                                      const std::vector<ClosedChannelSheet>& sheets, double dt) {
  const auto jump = [](const ClosedChannelSheet& sheet, double fluid) {
    const double w = sheet.velocity - fluid;
    return sheet.impermeable ? 0.0 : (sheet.alpha + sheet.beta * std::abs(w)) * w;
  };
  const auto all_jumps = [&](double fluid) {
    double sum = 0.0;
    for (const ClosedChannelSheet& sheet : sheets) sum += jump(sheet, fluid);
    return sum;
  };
  const double free = velocity + dt * acceleration;
  // The excess of the momentum rises with the velocity.
  const auto excess = [&](double fluid) { return mass * (fluid - free) / dt - all_jumps(fluid); };
  double low = free, high = free;
  for (const ClosedChannelSheet& sheet : sheets)
    low = std::min(low, sheet.velocity), high = std::max(high, sheet.velocity);
  const auto closed = std::ranges::find_if(sheets, &ClosedChannelSheet::impermeable);
  if (closed != sheets.end()) low = high = closed->velocity;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0.0 ? low : high) = middle;
  }
  ClosedChannelStep step{0.5 * (low + high), {}};
  for (const ClosedChannelSheet& sheet : sheets)
    step.pressure_jump.push_back(sheet.impermeable ? excess(step.velocity) : jump(sheet, step.velocity));
  return step;
}

}  // namespace drogue::reference
