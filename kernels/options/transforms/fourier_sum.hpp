#pragma once

#include "kernels/options/pide/thread_group.hpp"
#include "kernels/options/transforms/fourier.hpp"

namespace drogue::options {

/// Input of a sum over jumps by transforms; computed once per solve.
template <class R>
struct JumpSpectrum {
  FourierRoots roots;
  const ComplexNumber<R>* values;  ///< (padded(mesh)): transform of the weights, divided by the mesh
};

/// Passes of a transform of 2^log_size points: radix 8, but 2^last_log_radix in the last pass.
struct Passes {
  int log_size, last, last_log_radix;

  KOKKOS_INLINE_FUNCTION constexpr explicit Passes(int size) : log_size(0) {
    while (1 << log_size < size) ++log_size;
    last = (log_size - 1) / 3;
    last_log_radix = log_size - 3 * last;
  }
  /// Logarithm of the distance between the elements of a task; 0 in the last pass.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION constexpr int log_stride(int pass) const {
    return pass < last ? log_size - 3 * (pass + 1) : 0;
  }
};

/// Calls f(octet, factor) for all tasks of a pass on z and stores the modified octets. In the last pass
/// `factor` counts octets.
template <class ThreadGroup, class R, class F>
KOKKOS_INLINE_FUNCTION void for_each_octet(const ThreadGroup& group, const Passes& passes, int pass,
                                           ComplexNumber<R>* z, const F& f) {
  const int log_stride = passes.log_stride(pass), tasks = 1 << (passes.log_size - 3);
  group.each([=](int thread) {
    for (int task = thread; task < tasks; task += group.threads()) {
      const int factor = task >> log_stride, k = task - (factor << log_stride);
      ComplexNumber<R>* const own = z + padded((factor << (log_stride + 3)) + k);
      Octet<R> octet;
      octet.load(own, 1 << log_stride);
      f(octet, factor);
      octet.store(own, 1 << log_stride);
    }
  });
}

/// `for_each_octet` for the last pass, with its radix as a template argument: f.operator()<radix>(octet,
/// task).
template <class ThreadGroup, class R, class F>
KOKKOS_INLINE_FUNCTION void for_each_last_octet(const ThreadGroup& group, const Passes& passes,
                                                ComplexNumber<R>* z, const F& f) {
  const auto with = [&]<int radix>() {
    for_each_octet(group, passes, passes.last, z,
                   [=](Octet<R>& octet, int task) { f.template operator()<radix>(octet, task); });
  };
  if (passes.last_log_radix == 1) return with.template operator()<2>();
  if (passes.last_log_radix == 2) return with.template operator()<4>();
  with.template operator()<8>();
}

/// Transform of the weights of jumps, divided by the mesh, into `z` (padded(mesh)).
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION JumpSpectrum<R> spectrum_of(const ThreadGroup& group, int mesh,
                                                   const FourierRoots& roots, const R* w,
                                                   ComplexNumber<R>* z) {
  const WeightLayout<R> layout(mesh);
  const Passes passes(mesh);
  const double part = 1.0 / mesh;
  group.each([=](int thread) {
    for (int k = thread; k < mesh; k += group.threads())
      z[padded(k)] = {part * w[layout.place(mesh - k)], part * w[layout.place(-k)]};
  });
  for (int pass = 0; pass < passes.last; ++pass)
    for_each_octet(group, passes, pass, z,
                   [=](Octet<R>& octet, int factor) { octet.forward(roots.seven(pass, factor)); });
  for_each_last_octet(group, passes, z, [=]<int radix>(Octet<R>& octet, int task) {
    octet.template forward_last<radix>(roots, passes.last, task);
  });
  return {roots, z};
}

/// Sums over jumps w_{j-i} v_j at `mesh` nodes; overwrites `z` (padded(mesh)).
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void sum_by_transforms(const ThreadGroup& group, int mesh,
                                              const JumpSpectrum<R>& spectrum, const R* v, R* out,
                                              ComplexNumber<R>* z) {
  const Passes passes(mesh);
  const int stride = mesh / 8;
  const FourierRoots roots = spectrum.roots;
  const ComplexNumber<R>* const factors = spectrum.values;
  group.each([=](int thread) {
    for (int k = thread; k < stride; k += group.threads()) {
      Octet<R> octet;
      octet.forward_real([=](int m) { return v[k + m * stride]; });
      octet.store(z + padded(k), stride);
    }
  });
  for (int pass = 1; pass < passes.last; ++pass)
    for_each_octet(group, passes, pass, z,
                   [=](Octet<R>& octet, int factor) { octet.forward(roots.seven(pass, factor)); });
  for_each_last_octet(group, passes, z, [=]<int radix>(Octet<R>& octet, int task) {
    octet.template multiply_last<radix>(roots, passes.last, task, factors + padded(8 * task));
  });
  for (int pass = passes.last - 1; pass > 0; --pass)
    for_each_octet(group, passes, pass, z,
                   [=](Octet<R>& octet, int factor) { octet.inverse(roots.seven(pass, factor)); });
  group.each([=](int thread) {
    for (int k = thread; k < stride; k += group.threads()) {
      Octet<R> octet;
      octet.load(z + padded(k), stride);
      octet.inverse_imaginary([=](int m, R y) { out[k + m * stride] = y; });
    }
  });
}

}  // namespace drogue::options
