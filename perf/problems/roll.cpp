#include "perf/problems/roll.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/fabric/contact/features.hpp"
#include "kernels/reference/fabric/intersections.hpp"

namespace drogue::perf::roll {

using fabric::Vector;

namespace {

constexpr double inner_radius = 0.05;  // m
constexpr double peak_speed = 1.0;     // m/s, of the waves

/// Distance between layers, in thicknesses. Edges are chords of the spiral and a few per cent closer.
constexpr double pitch = 1.05;

/// Archimedes' spiral r = a angle in the plane normal to the axis of the roll.
struct Spiral {
  double a;

  /// Arc length from the centre.
  [[nodiscard]] double length(double angle) const {
    return 0.5 * a * (angle * std::hypot(1.0, angle) + std::asinh(angle));
  }
  /// Angle at an arc length, by Newton's method; the arc length is a convex function of the angle.
  [[nodiscard]] double angle(double arc_length) const {
    double angle = std::sqrt(2.0 * arc_length / a);
    for (int step = 0; step < 8; ++step) angle -= (length(angle) - arc_length) / (a * std::hypot(1.0, angle));
    return angle;
  }
};

}  // namespace

fabric::Parameters parameters(int vertices) {
  fabric::Parameters p = sheet::square(vertices);
  p.contact.self = true;
  p.contact.thickness = 0.4 * fabric::collision_edges(p.mesh).mean_length;
  p.contact.friction = 0.2;
  return p;
}

sheet::State start(const fabric::Parameters& p) {
  const Spiral spiral{pitch * p.contact.thickness / (2.0 * std::numbers::pi)};
  const double begin = spiral.length(inner_radius / spiral.a);
  sheet::State state;
  for (const Vector& at : p.mesh.rest) {
    const double angle = spiral.angle(begin + at[1]), radius = spiral.a * angle;
    const Vector outward = {0.0, std::cos(angle), std::sin(angle)};
    // Two and a half waves per turn: adjacent layers move in opposite directions.
    const double speed = peak_speed * std::cos(2.5 * angle) * std::cos(2.0 * std::numbers::pi * at[0]);
    state.x.push_back({at[0], radius * outward[1], radius * outward[2]});
    state.v.push_back({0.0, speed * outward[1], speed * outward[2]});
  }
  return state;
}

double default_dt(const fabric::Parameters& p, fabric::Solver& solver) {
  const sheet::State from = start(p);
  solver.upload(from.x, from.v);
  const double stable = fabric::stable_dt(p.integrator, solver.fastest_frequency(), solver.fastest_decay());
  return std::min(0.5 * stable, 0.1 * fabric::collision_edges(p.mesh).mean_length / peak_speed);
}

Sample steps(const sheet::Shared& p, const std::shared_ptr<fabric::Solver>& solver, long count) {
  Sample sample = sheet::steps_from(start(*p), solver, default_dt(*p, *solver), count);
  sample.reset = [solver, from = solver->download_state()] { solver->upload_state(from); };
  sample.error = [=] { return imbalance(*p, *solver); };
  return sample;
}

double imbalance(const fabric::Parameters& p, fabric::Solver& solver) {
  constexpr double wrong = std::numeric_limits<double>::infinity();
  if (solver.failure()) return wrong;
  const fabric::Totals end = solver.totals();
  if (end.contact == 0.0) return wrong;
  sheet::State state = start(p);
  solver.download(state.x, state.v);
  if (p.mass.size() <= most_checked && !reference::intersections(state.x, p.mesh.triangles, {}).empty())
    return wrong;
  state = start(p);
  solver.upload(state.x, state.v);
  const fabric::Totals begin = solver.totals();
  return std::abs(end.energy() - end.contact - end.friction - begin.energy()) / begin.kinetic;
}

}  // namespace drogue::perf::roll
