#include "kernels/reference/gas/muscl_hancock.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {

namespace {

constexpr std::size_t halo = 2;

/// Three values per cell or face, one row each.
struct Rows {
  std::vector<double> a, b, c;

  explicit Rows(std::size_t n) : a(n), b(n), c(n) {}
  void copy(std::size_t to, std::size_t from, double sign) {
    a[to] = a[from], b[to] = sign * b[from], c[to] = c[from];
  }
};

/// Conserved cells, their primitives (rho, u, p), the primitives at the two faces of a cell half a step
/// later, and the fluxes. Cell rows have `halo` ghost cells at either end.
struct Workspace {
  Rows conserved, primitive, at_left, at_right, flux;
  std::vector<double> speed;

  explicit Workspace(std::size_t n)
      : conserved(n + 2 * halo),
        primitive(n + 2 * halo),
        at_left(n + 2 * halo),
        at_right(n + 2 * halo),
        flux(n + 1),
        speed(n + 2 * halo) {}
};

double limited_slope(double below, double above) {
  const double size =
      std::min(2.0 * std::min(std::abs(below), std::abs(above)), 0.5 * std::abs(below + above));
  return below * above > 0.0 ? std::copysign(size, below) : 0.0;
}

void fill_ghosts(Rows& u, const gas::Parameters& p) {
  const std::size_t n = u.a.size() - 2 * halo, last = n + halo - 1;
  for (std::size_t k = 1; k <= halo; ++k) {
    const std::size_t left = halo - k, right = last + k;
    const auto image = [&](gas::Boundary kind, std::size_t ghost, std::size_t end, std::size_t mirrored,
                           std::size_t around) {
      if (kind == gas::Boundary::outflow) u.copy(ghost, end, 1.0);
      if (kind == gas::Boundary::reflecting) u.copy(ghost, mirrored, -1.0);
      if (kind == gas::Boundary::periodic) u.copy(ghost, around, 1.0);
    };
    image(p.left, left, halo, halo + k - 1, last + 1 - k);
    image(p.right, right, last, last + 1 - k, halo + k - 1);
  }
}

/// Fills the primitives. Returns max(|u|+c), m/s, or infinity if a cell is not physical.
double primitives(Workspace& w, double gamma) {
  const std::size_t n = w.primitive.a.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double rho = w.conserved.a[i], inverse = 1.0 / rho, u = w.conserved.b[i] * inverse;
    const double p = (gamma - 1.0) * (w.conserved.c[i] - 0.5 * w.conserved.b[i] * u);
    w.primitive.a[i] = rho, w.primitive.b[i] = u, w.primitive.c[i] = p;
    w.speed[i] = rho > 0.0 && p > 0.0 ? std::abs(u) + std::sqrt(gamma * p * inverse) : INFINITY;
  }
  return *std::max_element(w.speed.begin(), w.speed.end());
}

/// Two face states of every cell half a step later; the state of the cell itself if they are not physical.
void half_step(Workspace& w, double gamma, double dt_over_dx) {
  const Rows& v = w.primitive;
  const double h = 0.5 * dt_over_dx;
  const std::size_t n = v.a.size();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double rho = v.a[i], u = v.b[i], p = v.c[i];
    const double d_rho = limited_slope(rho - v.a[i - 1], v.a[i + 1] - rho);
    const double d_u = limited_slope(u - v.b[i - 1], v.b[i + 1] - u);
    const double d_p = limited_slope(p - v.c[i - 1], v.c[i + 1] - p);
    const double rho_half = rho - h * (u * d_rho + rho * d_u);
    const double u_half = u - h * (u * d_u + d_p / rho);
    const double p_half = p - h * (u * d_p + gamma * p * d_u);
    const double keep = rho_half > 0.5 * std::abs(d_rho) && p_half > 0.5 * std::abs(d_p) ? 1.0 : 0.0;
    const double rho_mean = keep > 0.0 ? rho_half : rho, p_mean = keep > 0.0 ? p_half : p;
    const double u_mean = keep > 0.0 ? u_half : u, half = 0.5 * keep;
    w.at_left.a[i] = rho_mean - half * d_rho, w.at_right.a[i] = rho_mean + half * d_rho;
    w.at_left.b[i] = u_mean - half * d_u, w.at_right.b[i] = u_mean + half * d_u;
    w.at_left.c[i] = p_mean - half * d_p, w.at_right.c[i] = p_mean + half * d_p;
  }
}

/// Flux F + signal (U* - U) of the state between a contact and the wave that approaches it.
inline Conserved star_flux(double rho, double u, double p, double e, double star, double contact,
                           double p_over_mass, double signal) {
  const double e_star = star * (e / rho + (contact - u) * (contact + p_over_mass));
  return {rho * u + signal * (star - rho), rho * u * u + p + signal * (star * contact - rho * u),
          u * (e + p) + signal * (e_star - e)};
}

/// HLLC flux of all faces.
void fluxes(Workspace& w, double gamma) {
  // Local pointers: the compiler cannot prove that storing a flux leaves the vectors in place.
  const std::size_t faces = w.flux.a.size(), i = halo - 1, j = halo;
  const double *rho_left = &w.at_right.a[i], *u_left = &w.at_right.b[i], *p_left = &w.at_right.c[i];
  const double *rho_right = &w.at_left.a[j], *u_right = &w.at_left.b[j], *p_right = &w.at_left.c[j];
  double *mass_flux = w.flux.a.data(), *momentum_flux = w.flux.b.data(), *energy_flux = w.flux.c.data();
#pragma GCC ivdep
  for (std::size_t f = 0; f < faces; ++f) {
    const double rho_l = rho_left[f], u_l = u_left[f], p_l = p_left[f];
    const double rho_r = rho_right[f], u_r = u_right[f], p_r = p_right[f];
    const double e_l = p_l / (gamma - 1.0) + 0.5 * rho_l * u_l * u_l;
    const double e_r = p_r / (gamma - 1.0) + 0.5 * rho_r * u_r * u_r;
    // The Roe averages and the wave speeds of both states bound the signals.
    const double root_l = std::sqrt(rho_l), root_r = std::sqrt(rho_r), inverse = 1.0 / (root_l + root_r);
    const double u_roe = (root_l * u_l + root_r * u_r) * inverse;
    const double h_roe = ((e_l + p_l) / root_l + (e_r + p_r) / root_r) * inverse;
    const double c_roe = std::sqrt((gamma - 1.0) * (h_roe - 0.5 * u_roe * u_roe));
    const double slow = std::min(u_l - std::sqrt(gamma * p_l / rho_l), u_roe - c_roe);
    const double fast = std::max(u_r + std::sqrt(gamma * p_r / rho_r), u_roe + c_roe);
    const double mass_l = rho_l * (slow - u_l), mass_r = rho_r * (fast - u_r);
    const double contact = (p_r - p_l + mass_l * u_l - mass_r * u_r) / (mass_l - mass_r);
    // The flux uses the side of the contact on which the face lies. A supersonic state uses only its own
    // flux.
    const Conserved left = star_flux(rho_l, u_l, p_l, e_l, mass_l / (slow - contact), contact, p_l / mass_l,
                                     std::min(slow, 0.0));
    const Conserved right = star_flux(rho_r, u_r, p_r, e_r, mass_r / (fast - contact), contact, p_r / mass_r,
                                      std::max(fast, 0.0));
    mass_flux[f] = contact >= 0.0 ? left[0] : right[0];
    momentum_flux[f] = contact >= 0.0 ? left[1] : right[1];
    energy_flux[f] = contact >= 0.0 ? left[2] : right[2];
  }
}

void update(std::vector<double>& row, const std::vector<double>& flux, double dt_over_dx) {
  const std::size_t faces = flux.size();
  for (std::size_t i = 0; i + 1 < faces; ++i) row[i + halo] += dt_over_dx * (flux[i] - flux[i + 1]);
}

}  // namespace

void muscl_hancock(GasRun& run, const gas::Parameters& p, double end_time) {
  const std::size_t n = run.state.size();
  const double dx = (p.x_max - p.x_min) / static_cast<double>(p.cells);
  Workspace w(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Conserved& u = run.state[i];
    w.conserved.a[i + halo] = u[0], w.conserved.b[i + halo] = u[1], w.conserved.c[i + halo] = u[2];
  }
  Rows before = w.conserved;
  fill_ghosts(w.conserved, p);
  double fastest = primitives(w, p.gamma);
  run.failed = !std::isfinite(fastest);
  while (run.time < end_time && !run.failed) {
    const double ramp =
        run.steps < p.ramp_steps ? 0.1 + 0.9 * static_cast<double>(run.steps) / p.ramp_steps : 1.0;
    const double remaining = end_time - run.time, dt = std::min(ramp * p.cfl * dx / fastest, remaining);
    run.failed = run.steps == p.max_steps || !(run.time + dt > run.time);
    if (run.failed) break;
    before = w.conserved;
    half_step(w, p.gamma, dt / dx);
    fluxes(w, p.gamma);
    update(w.conserved.a, w.flux.a, dt / dx);
    update(w.conserved.b, w.flux.b, dt / dx);
    update(w.conserved.c, w.flux.c, dt / dx);
    fill_ghosts(w.conserved, p);
    fastest = primitives(w, p.gamma);
    if (!std::isfinite(fastest)) {
      run.failed = true;
      w.conserved = before;
      break;
    }
    run.time = dt == remaining ? end_time : run.time + dt;
    ++run.steps;
  }
  for (std::size_t i = 0; i < n; ++i)
    run.state[i] = {w.conserved.a[i + halo], w.conserved.b[i + halo], w.conserved.c[i + halo]};
}

}  // namespace drogue::reference
