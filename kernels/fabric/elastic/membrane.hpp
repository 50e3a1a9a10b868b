#pragma once

#include "kernels/device/dual.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Constitutive model of a compiled kernel; `tension_only` elements become slack under compression.
struct ConstitutiveModel {
  Model model;
  bool tension_only = false;
};

/// True if triangles have an energy of their own. A constant, since nvcc rejects the constexpr function in
/// device code.
template <ConstitutiveModel model>
inline constexpr bool whole_triangles = has_triangles(model.model);

/// Lame's first constant and twice the shear modulus of plane stress, and Young's modulus, N/m. "mu"
/// in [Shi] is the second.
struct Moduli {
  double lambda, two_g, young;
};

/// Moduli of plane stress from Young's modulus times thickness, N/m, and Poisson's ratio. Does not throw.
[[nodiscard]] constexpr Moduli moduli(double membrane_modulus, double poisson) {
  return {membrane_modulus * poisson / (1.0 - poisson * poisson), membrane_modulus / (1.0 + poisson),
          membrane_modulus};
}

/// One value per edge of a triangle; edge e is opposite vertex e.
template <class R>
struct Edges {
  R of[3];
};

/// Scalar products of the edges from vertex 0 of a triangle to vertices j = 1 and k = 2, m^2.
template <class R>
struct GramMatrix {
  R jj, jk, kk;
};

/// Squared lengths of all edges, m^2, not negative in spite of rounding.
template <class R>
KOKKOS_INLINE_FUNCTION Edges<R> squared_edges(const GramMatrix<R>& of) {
  return {{device::maximum(of.jj + of.kk - 2.0 * of.jk, R(0.0)), of.kk, of.jj}};
}

/// Inverse area of a triangle from scalar products of its edges, 1/m^2; 0 without area. All drivers call it,
/// so that they get the same bits in the `exact` build. `spatial::inverse_area` of the edges has other bits.
template <class R>
KOKKOS_INLINE_FUNCTION R inverse_area(const GramMatrix<R>& rest) {
  const R squared = rest.jj * rest.kk - rest.jk * rest.jk;
  return device::select(squared > R(0.0), 2.0 * device::root(squared).inverse, R(0.0));
}

/// 2 dW/dq_e of the membrane energy W = A [(lambda + 2G)/2 tr(E)^2 - 2G det(E)] with Green's strain
/// E: its trace is sum(n_e q_e) / (16 A^2), n_e the sum of the other two L^2 less its own, and its
/// determinant (Q^2 - 2 sum(q_e^2)) / (64 A^2), Q = sum(q_e). `q` is l^2 - L^2 of the edges, `rest` L^2, m^2;
/// an inverse area of zero stands for no triangle. N/m. Delingette 2008, section 3, without stored
/// coefficients.
template <class R>
KOKKOS_INLINE_FUNCTION Edges<R> edge_tensions(const Moduli& m, const Edges<R>& q, const Edges<R>& rest,
                                              R inverse_area) {
  const R sum_rest = rest.of[0] + rest.of[1] + rest.of[2];
  const R n0 = sum_rest - 2.0 * rest.of[0], n1 = sum_rest - 2.0 * rest.of[1],
          n2 = sum_rest - 2.0 * rest.of[2];
  const R w = 0.0625 * inverse_area;
  const R volumetric =
      (2.0 * (m.lambda + m.two_g)) * (w * (w * inverse_area)) * (n0 * q.of[0] + n1 * q.of[1] + n2 * q.of[2]);
  const R shear = m.two_g * w;
  const R all = q.of[0] + q.of[1] + q.of[2];
  return {{volumetric * n0 + shear * (2.0 * q.of[0] - all), volumetric * n1 + shear * (2.0 * q.of[1] - all),
           volumetric * n2 + shear * (2.0 * q.of[2] - all)}};
}

/// `edge_tensions` of the edges to j and k alone, in the products g and, at rest, G: with d = g - G the sum
/// of the n_e q_e is 2 (G_kk d_jj + G_jj d_kk - 2 G_jk d_jk), n_k is 2 (G_jj - G_jk), and 2 q_k - Q is 2
/// (d_jk - d_jj).
template <class R>
struct EdgePairTensions {
  R j, k;
};
template <class R>
KOKKOS_INLINE_FUNCTION EdgePairTensions<R> edge_pair_tensions(const Moduli& m, const GramMatrix<R>& now,
                                                              const GramMatrix<R>& rest, R inverse_area) {
  const R jj = now.jj - rest.jj, jk = now.jk - rest.jk, kk = now.kk - rest.kk;
  const R volumetric = (0.03125 * (m.lambda + m.two_g)) * (inverse_area * inverse_area) *
                       (rest.kk * jj + rest.jj * kk - (rest.jk + rest.jk) * jk);
  const double shear = 0.125 * m.two_g;
  return {inverse_area * (volumetric * (rest.kk - rest.jk) + shear * (jk - kk)),
          inverse_area * (volumetric * (rest.jj - rest.jk) + shear * (jk - jj))};
}

/// `edge_tensions` of the relaxed energy (Pipkin 1986, Steigmann 1990), the least that wrinkles finer than
/// the mesh can leave: with principal strains E1 >= E2 the sheet is taut where the minor stress is not
/// negative, else, where E1 > 0, wrinkled and in uniaxial tension, young E1, and else slack. A stress a 1 - b
/// cof(E) has the tensions (2 a n_e + b (2 q_e - Q)) / (16 A). The force is continuous.
template <class R>
KOKKOS_INLINE_FUNCTION Edges<R> relaxed_tensions(const Moduli& m, const Edges<R>& q, const Edges<R>& rest,
                                                 R inverse_area) {
  const R sum_rest = rest.of[0] + rest.of[1] + rest.of[2], all = q.of[0] + q.of[1] + q.of[2];
  const R n[3] = {sum_rest - 2.0 * rest.of[0], sum_rest - 2.0 * rest.of[1], sum_rest - 2.0 * rest.of[2]};
  const R w = 0.0625 * inverse_area, per_area = w * inverse_area, zero = R(0.0);
  const R trace = per_area * (n[0] * q.of[0] + n[1] * q.of[1] + n[2] * q.of[2]);
  const R squares = q.of[0] * q.of[0] + q.of[1] * q.of[1] + q.of[2] * q.of[2];
  const R determinant = 0.25 * per_area * (all * all - 2.0 * squares);
  const R radius = device::square_root(device::maximum(0.25 * trace * trace - determinant, zero));
  const R major = 0.5 * trace + radius;
  const R taut = (m.lambda + m.two_g) * trace;
  const auto is_taut = taut - m.two_g * major >= zero;
  const auto is_wrinkled = major > zero;
  const R wrinkled = device::select(is_wrinkled, 0.5 * m.young * major / radius, zero);
  const R a = device::select(is_taut, taut, wrinkled * major),
          b = device::select(is_taut, R(m.two_g), wrinkled);
  return {{w * (2.0 * a * n[0] + b * (2.0 * q.of[0] - all)), w * (2.0 * a * n[1] + b * (2.0 * q.of[1] - all)),
           w * (2.0 * a * n[2] + b * (2.0 * q.of[2] - all))}};
}

/// Tensions of the relaxed or the plain energy, N/m.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION Edges<R> tensions_of_changes(const Moduli& m, const Edges<R>& q, const Edges<R>& rest,
                                                    R inverse_area) {
  if constexpr (model.tension_only)
    return relaxed_tensions(m, q, rest, inverse_area);
  else
    return edge_tensions(m, q, rest, inverse_area);
}

/// Strain measures of the edges in which the energy is quadratic, m^2: l^2 - L^2, or 2 L (l - L) for
/// Model::quadratic. `now` and `rest` are squared lengths, m^2.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION Edges<R> changes(const Edges<R>& now, const Edges<R>& rest) {
  static_assert(whole_triangles<model>, "springs along edges have no triangles");
  Edges<R> q;
  for (int e = 0; e < 3; ++e)
    if constexpr (model.model == Model::biquadratic)
      q.of[e] = now.of[e] - rest.of[e];
    else if constexpr (model.model == Model::quadratic)
      q.of[e] = 2.0 * (device::square_root(rest.of[e] * now.of[e]) - rest.of[e]);
    else
      static_assert(!whole_triangles<model>, "the strain measure of this model is missing");
  return q;
}

/// Tension of each edge, N/m: the force on a vertex is that of an edge times the vector to its other vertex.
/// `now` and `rest` are squared lengths.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION Edges<R> membrane_tensions(const Moduli& m, const Edges<R>& now, const Edges<R>& rest,
                                                  R inverse_area) {
  const Edges<R> q = changes<model>(now, rest);
  Edges<R> s = tensions_of_changes<model>(m, q, rest, inverse_area);
  if constexpr (model.model == Model::quadratic) {
    // dW/dl = dW/dq 2 L, and the edge vector is l long: times L / l = (q / 2 + L^2) / l^2.
    for (int e = 0; e < 3; ++e)
      s.of[e] =
          device::select(now.of[e] > R(0.0), (0.5 * q.of[e] + rest.of[e]) / now.of[e], R(0.0)) * s.of[e];
  }
  return s;
}

/// Energy of a triangle, J. The plain and the relaxed energy are homogeneous of degree two: half of the
/// derivative times the argument.
template <ConstitutiveModel model>
KOKKOS_INLINE_FUNCTION double membrane_energy(const Moduli& m, const Edges<double>& now,
                                              const Edges<double>& rest, double inverse_area) {
  const Edges<double> q = changes<model>(now, rest), s = tensions_of_changes<model>(m, q, rest, inverse_area);
  return 0.25 * (s.of[0] * q.of[0] + s.of[1] * q.of[1] + s.of[2] * q.of[2]);
}

/// Tension of a spring of stiffness `k` (N/m) and length at rest `rest` (m), N/m; `now` is its squared
/// length, m^2. Zero for a spring of no length, which has no direction.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION R spring_tension(R k, R now, R rest) {
  const R tension = device::select(now > R(0.0), k * (R(1.0) - rest / device::square_root(now)), R(0.0));
  if constexpr (model.tension_only)
    return device::maximum(tension, R(0.0));
  else
    return tension;
}

/// Energy of a spring, J; `now` is its squared length.
template <ConstitutiveModel model>
KOKKOS_INLINE_FUNCTION double spring_energy(double k, double now, double rest) {
  const double change = device::square_root(now) - rest;
  return model.tension_only && change < 0.0 ? 0.0 : 0.5 * k * change * change;
}

}  // namespace drogue::fabric
