#include "kernels/reference/gas/advection.hpp"

#include <cmath>

#include "kernels/reference/gas/weno.hpp"

namespace drogue::reference {

namespace {

using Cells = std::vector<double>;

/// keep * start + (1 - keep) * (u - lambda * difference of upwind fluxes)
Cells stage(const Cells& start, const Cells& u, double keep, double lambda, gas::Weno scheme, int power) {
  const std::size_t n = u.size();
  Cells flux(n);  // at the right face of each cell
  for (std::size_t i = 0; i < n; ++i) {
    std::array<double, 5> f{};
    for (std::size_t k = 0; k < 5; ++k) f[k] = u[(i + k + n - 2) % n];
    flux[i] = weno_face_value(f, scheme, power);
  }
  Cells updated(n);
  for (std::size_t i = 0; i < n; ++i)
    updated[i] = keep * start[i] + (1.0 - keep) * (u[i] - lambda * (flux[i] - flux[(i + n - 1) % n]));
  return updated;
}

}  // namespace

std::vector<double> advect(std::size_t cells, const std::function<double(double)>& initial, double end_time,
                           gas::Weno scheme, int power, double dt_factor) {
  const double dx = 2.0 / static_cast<double>(cells);
  Cells u(cells);
  for (std::size_t i = 0; i < cells; ++i) u[i] = initial(-1.0 + (static_cast<double>(i) + 0.5) * dx);
  const double steps = std::ceil(end_time / (dt_factor * std::pow(dx, 5.0 / 3.0)));
  const double lambda = end_time / steps / dx;
  for (double step = 0.0; step < steps; ++step) {
    const Cells first = stage(u, u, 0.0, lambda, scheme, power);
    const Cells second = stage(u, first, 3.0 / 4.0, lambda, scheme, power);
    u = stage(u, second, 1.0 / 3.0, lambda, scheme, power);
  }
  return u;
}

}  // namespace drogue::reference
