#pragma once

#include "kernels/options/fourier.hpp"
#include "kernels/options/workers.hpp"

namespace drogue::options {

/// What a sum over jumps by transforms reads: made once a solve.
template <class R>
struct JumpSpectrum {
  FourierRoots roots;
  const Complex<R>* place;  ///< (padded(mesh)): the weights' transform, divided by the mesh
};

/// Passes of a transform of `mesh` points; the last one has `last_radix`, the others eight.
KOKKOS_INLINE_FUNCTION constexpr int last_level(int mesh) {
  int level = 0;
  for (int rest = mesh; rest > 8; rest /= 8) ++level;
  return level;
}

/// Calls f(octet, own, stride, factor) for the numbers of all tasks of a level.
template <class Workers, class R, class F>
KOKKOS_INLINE_FUNCTION void each_octet(const Workers& workers, int mesh, int level, Complex<R>* z,
                                       const F& f) {
  const int stride = mesh >> (3 * (level + 1));
  workers.each([=](int lane) {
    for (int task = lane; task < mesh / 8; task += lanes) {
      const int factor = task / stride, k = task % stride;
      Complex<R>* const own = z + padded(8 * stride * factor + k);
      Octet<R> octet;
      octet.load(own, stride);
      f(octet, factor);
      octet.store(own, stride);
    }
  });
}

/// Calls f.operator()<radix>() with the radix of the last pass.
template <class F>
KOKKOS_INLINE_FUNCTION void with_last_radix(int mesh, const F& f) {
  const int radix = mesh >> (3 * last_level(mesh));
  if (radix == 2) return f.template operator()<2>();
  if (radix == 4) return f.template operator()<4>();
  f.template operator()<8>();
}

/// The last pass forward, `f(octet, first)` on eight neighbours of the transform, and whatever is written
/// back.
template <class Workers, class R, class F>
KOKKOS_INLINE_FUNCTION void each_last(const Workers& workers, int mesh, Complex<R>* z, const F& f) {
  workers.each([=](int lane) {
    for (int task = lane; task < mesh / 8; task += lanes) {
      Octet<R> octet;
      octet.load(z + padded(8 * task), 1);
      f(octet, task);
      octet.store(z + padded(8 * task), 1);
    }
  });
}

/// The transform of the weights of jumps, divided by the mesh, into `z` (padded(mesh)).
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION JumpSpectrum<R> spectrum_of(const Workers& workers, int mesh,
                                                   const FourierRoots& roots, const R* w, Complex<R>* z) {
  const WeightLayout<R> layout(mesh);
  const double part = 1.0 / mesh;
  workers.each([=](int lane) {
    for (int k = lane; k < mesh; k += lanes)
      z[padded(k)] = {part * w[layout.place(mesh - k)], part * w[layout.place(-k)]};
  });
  const int last = last_level(mesh);
  for (int level = 0; level < last; ++level)
    each_octet(workers, mesh, level, z,
               [=](Octet<R>& octet, int factor) { octet.split(roots, level, factor); });
  with_last_radix(mesh, [=, &workers]<int radix>() {
    each_last(workers, mesh, z, [=](Octet<R>& octet, int task) {
      octet.template split_last<radix>(roots, last, task * (8 / radix));
    });
  });
  return {roots, z};
}

/// The sums over jumps w_{j-i} v_j of `mesh` nodes; `z` (padded(mesh)) is spoiled.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void sum_by_transforms(const Workers& workers, int mesh,
                                              const JumpSpectrum<R>& spectrum, const R* v, R* out,
                                              Complex<R>* z) {
  const int last = last_level(mesh), stride = mesh / 8;
  const FourierRoots roots = spectrum.roots;
  const Complex<R>* const factors = spectrum.place;
  workers.each([=](int lane) {
    for (int k = lane; k < stride; k += lanes) {
      Octet<R> octet;
      octet.split_real([=](int m) { return v[k + m * stride]; });
      octet.store(z + padded(k), stride);
    }
  });
  for (int level = 1; level < last; ++level)
    each_octet(workers, mesh, level, z,
               [=](Octet<R>& octet, int factor) { octet.split(roots, level, factor); });
  with_last_radix(mesh, [=, &workers]<int radix>() {
    each_last(workers, mesh, z, [=](Octet<R>& octet, int task) {
      octet.template multiply_last<radix>(roots, last, task, factors + padded(8 * task));
    });
  });
  for (int level = last - 1; level > 0; --level)
    each_octet(workers, mesh, level, z,
               [=](Octet<R>& octet, int factor) { octet.join(roots, level, factor); });
  workers.each([=](int lane) {
    for (int k = lane; k < stride; k += lanes) {
      Octet<R> octet;
      octet.load(z + padded(k), stride);
      octet.join_imaginary([=](int m, R y) { out[k + m * stride] = y; });
    }
  });
}

}  // namespace drogue::options
