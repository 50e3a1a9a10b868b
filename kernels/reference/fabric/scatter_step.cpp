#include "kernels/reference/fabric/scatter_step.hpp"

#include <cmath>

namespace drogue::reference {

using fabric::Vector;

namespace {

Vector edge_between(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double squared(const Vector& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

}  // namespace

ScatterSheet::ScatterSheet(const fabric::Parameters& p)
    : _mass(p.mass), _pinned(p.pinned), _gravity(p.gravity), _damping(p.damping) {
  const double nu = p.material.poisson, young = p.material.membrane_modulus;
  const double lambda = young * nu / (1.0 - nu * nu), mu = young / (1.0 + nu);
  for (const auto& t : p.mesh.triangles) {
    Springs s{};
    for (std::size_t e = 0; e < 3; ++e) {
      s.vertex[e] = static_cast<std::size_t>(t[e]);
      s.rest[e] = squared(edge_between(p.mesh.rest[static_cast<std::size_t>(t[(e + 1) % 3])],
                                       p.mesh.rest[static_cast<std::size_t>(t[(e + 2) % 3])]));
    }
    // Heron's formula.
    const double all = s.rest[0] + s.rest[1] + s.rest[2];
    const double area =
        0.25 *
        std::sqrt(all * all - 2.0 * (s.rest[0] * s.rest[0] + s.rest[1] * s.rest[1] + s.rest[2] * s.rest[2]));
    double cotangent[3];
    for (std::size_t e = 0; e < 3; ++e) cotangent[e] = (all - 2.0 * s.rest[e]) / (4.0 * area);
    for (std::size_t e = 0; e < 3; ++e) {
      s.tensile[e] = (2.0 * cotangent[e] * cotangent[e] * (lambda + mu) + mu) / (16.0 * area);
      s.angular[e] =
          (2.0 * cotangent[(e + 1) % 3] * cotangent[(e + 2) % 3] * (lambda + mu) - mu) / (16.0 * area);
    }
    _triangles.push_back(s);
  }
  for (std::size_t k = 0; k < 4; ++k) _a[k] = _v[k] = p.mesh.rest;
  _at = p.mesh.rest;
}

void ScatterSheet::forces(const std::vector<Vector>& x, std::vector<Vector>& f) const {
  for (Vector& force : f) force = {};
  for (const Springs& s : _triangles) {
    Vector edge[3];
    double change[3];
    for (std::size_t e = 0; e < 3; ++e) {
      edge[e] = edge_between(x[s.vertex[(e + 2) % 3]], x[s.vertex[(e + 1) % 3]]);
      change[e] = squared(edge[e]) - s.rest[e];
    }
    for (std::size_t e = 0; e < 3; ++e) {
      const std::size_t next = (e + 1) % 3, last = (e + 2) % 3;
      const double tension =
          s.tensile[e] * change[e] + s.angular[last] * change[next] + s.angular[next] * change[last];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        f[s.vertex[next]][axis] += tension * edge[e][axis];
        f[s.vertex[last]][axis] -= tension * edge[e][axis];
      }
    }
  }
}

void ScatterSheet::slopes(const std::vector<Vector>& x, const std::vector<Vector>& v,
                          std::vector<Vector>& a) {
  forces(x, a);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool pinned = !_pinned.empty() && (_pinned[i] >> axis & 1U) != 0U;
      a[i][axis] = pinned ? 0.0 : a[i][axis] / _mass[i] + _gravity[axis] - _damping * v[i][axis];
    }
}

void ScatterSheet::step(double dt, std::vector<Vector>& x, std::vector<Vector>& v) {
  _v[0] = v;
  slopes(x, _v[0], _a[0]);
  for (std::size_t stage = 1; stage < 4; ++stage) {
    const double part = stage == 3 ? dt : 0.5 * dt;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        _at[i][axis] = x[i][axis] + part * _v[stage - 1][i][axis];
        _v[stage][i][axis] = v[i][axis] + part * _a[stage - 1][i][axis];
      }
    slopes(_at, _v[stage], _a[stage]);
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto mean = [&](const auto& k) {
        return (k[0][i][axis] + 2.0 * (k[1][i][axis] + k[2][i][axis]) + k[3][i][axis]) / 6.0;
      };
      x[i][axis] += dt * mean(_v);
      v[i][axis] += dt * mean(_a);
    }
}

}  // namespace drogue::reference
