#pragma once

#include "kernels/options/grid/grid.hpp"
#include "kernels/options/transforms/fourier_roots.hpp"

/// Sum over jumps y_i = sum_j w_{j-i} v_j by Fourier transforms. With V = sum v_k x^k and W = sum w_{n-k}
/// x^k, k < 2n, the y_i are the coefficients n .. 2n - 1 of V W. Its remainder modulo x^n - i is P0 + i P1 -
/// P2 for the three parts of n coefficients each. All parts are real, so P1 is the imaginary part, and n
/// complex points are sufficient. The remainder is reduced modulo the eight factors of x^n - i, and
/// recursively to x - e^{2 pi i phi} (`FourierRoots`). Products of these remainders are transformed back to
/// the product of V and W.
namespace drogue::options {

/// Discrete Fourier transforms of 2, 4 and 8 values in place: sum_m z_m e^{sign 2 pi i q m/size}, q = 0 ..
/// size - 1.
template <int sign, class R>
KOKKOS_INLINE_FUNCTION void transform(ComplexNumber<R>& z0, ComplexNumber<R>& z1) {
  const ComplexNumber<R> first = z0;
  z0 = first + z1;
  z1 = first - z1;
}
template <int sign, class R>
KOKKOS_INLINE_FUNCTION void transform(ComplexNumber<R>& z0, ComplexNumber<R>& z1, ComplexNumber<R>& z2,
                                      ComplexNumber<R>& z3) {
  const ComplexNumber<R> a = z0 + z2, b = z0 - z2, c = z1 + z3, d = times_i<sign>(z1 - z3);
  z0 = a + c;
  z1 = b + d;
  z2 = a - c;
  z3 = b - d;
}
template <int sign, class R>
KOKKOS_INLINE_FUNCTION void transform(ComplexNumber<R> (&z)[8]) {
  ComplexNumber<R> even[4], odd[4];
  for (int m = 0; m < 4; ++m) {
    even[m] = z[m] + z[m + 4];
    odd[m] = z[m] - z[m + 4];
  }
  transform<sign>(even[0], even[1], even[2], even[3]);
  // odd[m] e^{sign 2 pi i m/8}. The factor sqrt(1/2) of m = 1 and 3 is applied last, and m = 3 is negated.
  constexpr double diagonal = 0.70710678118654752440;
  const ComplexNumber<R> second = times_i<sign>(odd[2]), first = odd[1] + times_i<sign>(odd[1]),
                         third = odd[3] - times_i<sign>(odd[3]);
  const ComplexNumber<R> a = odd[0] + second, b = odd[0] - second, sum = first - third,
                         difference = times_i<sign>(first + third);
  const ComplexNumber<R> c = {diagonal * sum.re, diagonal * sum.im},
                         d = {diagonal * difference.re, diagonal * difference.im};
  for (int q = 0; q < 4; ++q) z[2 * q] = even[q];
  z[1] = a + c;
  z[3] = b + d;
  z[5] = a - c;
  z[7] = b - d;
}

/// cos(2 pi m/32), m = 0 .. 8; the sine is the cosine of 8 - m.
struct QuarterCosines {
  double cosine[9] = {1.0,
                      0.98078528040323044913,
                      0.92387953251128675613,
                      0.83146961230254523708,
                      0.70710678118654752440,
                      0.55557023301960222474,
                      0.38268343236508977173,
                      0.19509032201612826785,
                      0.0};
};

/// Eight values that one pass transforms in place. They are `stride` elements apart in memory.
template <class R>
struct Octet {
  ComplexNumber<R> z[8];

  KOKKOS_INLINE_FUNCTION void load(const ComplexNumber<R>* from, int stride) {
    for (int m = 0; m < 8; ++m) z[m] = from[padded(m * stride)];
  }
  KOKKOS_INLINE_FUNCTION void store(ComplexNumber<R>* to, int stride) const {
    for (int m = 0; m < 8; ++m) to[padded(m * stride)] = z[m];
  }
  /// Remainders modulo the eight factors of a factor with these roots (`forward`), and the inverse.
  KOKKOS_INLINE_FUNCTION void forward(const SevenRoots& roots) {
    for (int m = 1; m < 8; ++m) z[m] = product(z[m], roots.root[m - 1]);
    transform<1>(z);
  }
  KOKKOS_INLINE_FUNCTION void inverse(const SevenRoots& roots) {
    transform<-1>(z);
    for (int m = 1; m < 8; ++m) z[m] = times_conjugate(z[m], roots.root[m - 1]);
  }
  /// Last pass, in which a factor has only `radix` adjacent elements, of the octet `task`.
  template <int radix>
  KOKKOS_INLINE_FUNCTION void forward_last(const FourierRoots& roots, int level, int task) {
    if constexpr (radix == 8) {
      forward(roots.seven(level, task));
    } else {
      for (int k = 0; k < 8; k += radix) {
        for (int m = 1; m < radix; ++m)
          z[k + m] = product(z[k + m], roots.at(level, m * (8 / radix), (8 * task + k) / radix));
        transform_few<1, radix>(k);
      }
    }
  }
  template <int radix>
  KOKKOS_INLINE_FUNCTION void inverse_last(const FourierRoots& roots, int level, int task) {
    if constexpr (radix == 8) {
      inverse(roots.seven(level, task));
    } else {
      for (int k = 0; k < 8; k += radix) {
        transform_few<-1, radix>(k);
        for (int m = 1; m < radix; ++m)
          z[k + m] = times_conjugate(z[k + m], roots.at(level, m * (8 / radix), (8 * task + k) / radix));
      }
    }
  }

  /// First pass, for the real values read(m), and the last inverse pass, whose imaginary parts are passed to
  /// write(m, y). The roots of level 0 are e^{2 pi i m/32}.
  template <class Read>
  KOKKOS_INLINE_FUNCTION void forward_real(const Read& read) {
    constexpr QuarterCosines turn;
    z[0] = {read(0), R(0.0)};
    for (int m = 1; m < 8; ++m) {
      const R v = read(m);
      z[m] = {v * turn.cosine[m], v * turn.cosine[8 - m]};
    }
    transform<1>(z);
  }
  template <class Write>
  KOKKOS_INLINE_FUNCTION void inverse_imaginary(const Write& write) {
    constexpr QuarterCosines turn;
    transform<-1>(z);
    write(0, z[0].im);
    for (int m = 1; m < 8; ++m) write(m, z[m].im * turn.cosine[m] - z[m].re * turn.cosine[8 - m]);
  }

  /// Last forward pass, product with eight values of the spectrum, and first inverse pass.
  template <int radix>
  KOKKOS_INLINE_FUNCTION void multiply_last(const FourierRoots& roots, int level, int task,
                                            const ComplexNumber<R>* spectrum) {
    forward_last<radix>(roots, level, task);
    for (int m = 0; m < 8; ++m) z[m] = product(z[m], spectrum[m]);
    inverse_last<radix>(roots, level, task);
  }

 private:
  template <int sign, int radix>
  KOKKOS_INLINE_FUNCTION void transform_few(int k) {
    if constexpr (radix == 2) transform<sign>(z[k], z[k + 1]);
    if constexpr (radix == 4) transform<sign>(z[k], z[k + 1], z[k + 2], z[k + 3]);
  }
};

}  // namespace drogue::options
