#pragma once

#include <cmath>
#include <functional>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/fabric/parameters.hpp"

namespace drogue::testing {

using fabric::Vector;

/// Sheets with contact, in their initial state.
struct Sheets {
  fabric::Parameters p;
  std::vector<Vector> x, v;

  /// Common parameters of all tests: 0.2 kg/m^2, velocity Verlet, self-contact.
  Sheets() {
    p.integrator = fabric::Integrator::verlet;
    p.contact.self = true;
    p.contact.friction = 0.3;
    p.dt = 5e-5;
  }

  /// Adds a sheet of n by n vertices with side length `side`, m, and alternating diagonals. `place` maps
  /// coordinates in the sheet to initial positions, m.
  void add(int n, double side, const std::function<Vector(double, double)>& place, const Vector& velocity) {
    const int first = static_cast<int>(p.mesh.rest.size());
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double a = side * i / (n - 1), b = side * j / (n - 1);
        p.mesh.rest.push_back({a, b, 10.0 * first});
        x.push_back(place(a, b));
        v.push_back(velocity);
      }
    for (int j = 0; j + 1 < n; ++j)
      for (int i = 0; i + 1 < n; ++i) {
        const int a = first + j * n + i, b = a + 1, c = a + n, d = c + 1;
        if ((i + j) % 2 == 0) {
          p.mesh.triangles.push_back({a, b, d}), p.mesh.triangles.push_back({a, d, c});
        } else {
          p.mesh.triangles.push_back({a, b, c}), p.mesh.triangles.push_back({b, d, c});
        }
      }
    p.mass = fabric::lumped_masses(p.mesh, 0.2, 0.0, fabric::Lumping::area);
  }
};

/// Flat, its corner at an offset.
inline std::function<Vector(double, double)> level(double x, double y, double z) {
  return [=](double a, double b) { return Vector{a + x, b + y, z}; };
}

/// A sheet falls flat on one that rests.
inline Sheets impact(double speed) {
  Sheets s;
  s.add(10, 0.1, level(0.0, 0.0, 0.0), {0.0, 0.0, 0.0});
  s.add(8, 0.07, level(0.0131, 0.0177, 0.008), {0.1 * speed, 0.0, -speed});
  return s;
}

/// A sheet stands on its edge above the middle of one, and falls.
inline Sheets edge_on(double speed) {
  Sheets s;
  s.add(10, 0.1, level(0.0, 0.0, 0.0), {0.0, 0.0, 0.0});
  s.add(8, 0.07,
        [](double a, double b) {
          return Vector{a + 0.0131, 0.0517 + 0.1 * b, 0.006 + b};
        },
        {0.0, 0.0, -speed});
  return s;
}

/// Two sheets of one plane meet with their corners.
inline Sheets corner_on(double speed) {
  Sheets s;
  s.add(8, 0.07, level(0.0, 0.0, 0.0), {speed, speed, 0.0});
  s.add(8, 0.07, level(0.074, 0.074, 0.0), {-speed, -speed, 0.0});
  return s;
}

/// A sheet bent over by half a turn, the flaps moving towards one another.
inline Sheets folded(double speed) {
  Sheets s;
  const double radius = 0.012, arc = std::acos(-1.0) * radius, middle = 0.06;
  s.add(12, 0.12,
        [=](double a, double b) {
          const double along = a - middle;
          if (along < -0.5 * arc) return Vector{a, b, 0.0};
          if (along > 0.5 * arc) return Vector{2.0 * middle - a, b, 2.0 * radius};
          const double turn = (along + 0.5 * arc) / radius;
          return Vector{middle - 0.5 * arc + radius * std::sin(turn), b, radius * (1.0 - std::cos(turn))};
        },
        {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < s.x.size(); ++i)
    if (s.x[i][2] > radius) s.v[i] = {0.0, 0.0, -speed};
  return s;
}

/// Three sheets, each a little turned, fall on a rough floor.
inline Sheets stack() {
  Sheets s;
  for (int k = 0; k < 3; ++k) {
    const double turn = 0.1 * k;
    s.add(6, 0.06,
          [=](double a, double b) {
            return Vector{std::cos(turn) * a - std::sin(turn) * b, std::sin(turn) * a + std::cos(turn) * b,
                          0.003 + 0.004 * k};
          },
          {0.0, 0.0, 0.0});
  }
  s.p.gravity = {0.0, 0.0, -9.81};
  fabric::Body floor;
  floor.kind = fabric::BodyKind::plane;
  floor.friction = 0.3;
  s.p.contact.bodies = {floor};
  return s;
}

/// A sheet that flies at lines from one vertex, which has more constraints than lists of vertices hold.
inline Sheets above_a_fan_of_lines() {
  Sheets s;
  s.add(12, 0.1, level(0.0, 0.0, 0.003), {0.0, 0.0, -3.0});
  const int hub = static_cast<int>(s.x.size());
  constexpr int lines = 9;
  for (int k = -1; k < lines; ++k) {
    const Vector at = k < 0 ? Vector{0.0512, -0.03, 0.0} : Vector{0.013 + 0.009 * k, 0.13, 0.0};
    s.p.mesh.rest.push_back({at[0], at[1], 5.0});
    s.x.push_back(at);
    s.v.push_back({0.0, 0.0, 0.0});
    s.p.mass.push_back(k < 0 ? 0.02 : 0.002);
    if (k >= 0) s.p.mesh.lines.push_back({hub, hub + 1 + k});
  }
  s.p.material.axial_stiffness = 500.0;
  s.p.material.tension_only = true;
  s.p.integrator = fabric::Integrator::symplectic_euler;
  return s;
}

}  // namespace drogue::testing
