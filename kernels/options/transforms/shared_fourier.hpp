#pragma once

#include "kernels/options/transforms/fourier_sum.hpp"
#include "kernels/options/transforms/lane_nodes.hpp"

namespace drogue::options {

/// The even or the `odd` elements of `transform` of eight values, with the same operations. Two threads that
/// share an octet compute one half each.
template <int sign>
KOKKOS_INLINE_FUNCTION void transform_half(const ComplexNumber<double> (&low)[4],
                                           const ComplexNumber<double> (&high)[4], bool odd,
                                           ComplexNumber<double> (&half)[4]) {
  const auto either = [odd](const ComplexNumber<double>& if_odd, const ComplexNumber<double>& if_even) {
    return ComplexNumber<double>{odd ? if_odd.re : if_even.re, odd ? if_odd.im : if_even.im};
  };
  const double scale = odd ? 0.70710678118654752440 : 1.0;
  ComplexNumber<double> z[4];
  for (int m = 0; m < 4; ++m) z[m] = low[m] + high[m];
  const ComplexNumber<double> second = either(times_i<sign>(z[2]), z[2]),
                              first = either(z[1] + times_i<sign>(z[1]), z[1]),
                              third = either(times_i<sign>(z[3]) - z[3], z[3]);
  const ComplexNumber<double> a = z[0] + second, b = z[0] - second, sum = first + third,
                              difference = times_i<sign>(first - third);
  const ComplexNumber<double> c = {scale * sum.re, scale * sum.im},
                              d = {scale * difference.re, scale * difference.im};
  half[0] = a + c;
  half[1] = b + d;
  half[2] = a - c;
  half[3] = b - d;
}

/// `RegisterFourier` of 128 nodes for all threads of a warp, four nodes each. The threads t and t + 16 share
/// an octet: one computes the even elements, the other one the odd elements. The thread that computes an
/// element also multiplies it by the root of the next pass. Where there is no root the factor is {1, 0},
/// which can only change the sign of a zero.
class SharedFourier {
 public:
  /// `row` (mesh) and `z` (padded(mesh)) are shared memory, used exclusively from the first call on.
  KOKKOS_INLINE_FUNCTION SharedFourier(int thread, const JumpSpectrum<double>& spectrum, double* row,
                                       ComplexNumber<double>* z)
      : _thread(thread),
        _octet(thread % octets),
        _odd(thread / octets),
        _row(row),
        _first(z + padded(_octet)),
        _second(z + padded(_octet / 2 * 16 + _octet % 2)),
        _third(z + padded(4 * thread)) {
    const int m = _octet / 2;  // index of the element in its octet of the second pass
    for (int j = 0; j < 4; ++j) {
      const int q = 2 * j + _odd;
      _forward_roots[j] = m > 0 ? spectrum.roots.at(1, m, q) : ComplexNumber<double>{1.0, 0.0};
      _inverse_roots[j] = q > 0 ? spectrum.roots.at(1, q, _octet / 2) : ComplexNumber<double>{1.0, 0.0};
      _spectrum[j] = spectrum.values[padded(4 * thread) + j];
    }
    for (int k = 0; k < 2; ++k) _last[k] = spectrum.roots.at(2, 4, 2 * thread + k);
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION LaneNodes<4> operator()(const ThreadGroup& group, const LaneNodes<4>& value) const {
    const bool odd = _odd != 0;
    ComplexNumber<double> low[4], high[4], half[4];
    group.each_lane([&] { value.store_swizzled(_thread, _row); });
    group.each_lane([&] {
      real_halves(low, high);
      transform_half<1>(low, high, odd, half);
      for (int j = 0; j < 4; ++j)
        _first[padded(octets * (2 * j + _odd))] = product(half[j], _forward_roots[j]);
    });
    group.each_lane([&] { load(_second, 2, low, high); });
    group.each_lane([&] {
      transform_half<1>(low, high, odd, half);
      for (int j = 0; j < 4; ++j) _second[padded(2 * (2 * j + _odd))] = half[j];
    });
    group.each_lane([&] {
      for (int k = 0; k < 2; ++k) {
        ComplexNumber<double> z[2] = {_third[2 * k], product(_third[2 * k + 1], _last[k])};
        transform<1>(z[0], z[1]);
        for (int m = 0; m < 2; ++m) z[m] = product(z[m], _spectrum[2 * k + m]);
        transform<-1>(z[0], z[1]);
        _third[2 * k] = z[0];
        _third[2 * k + 1] = times_conjugate(z[1], _last[k]);
      }
    });
    group.each_lane([&] { load(_second, 2, low, high); });
    group.each_lane([&] {
      transform_half<-1>(low, high, odd, half);
      for (int j = 0; j < 4; ++j)
        _second[padded(2 * (2 * j + _odd))] = times_conjugate(half[j], _inverse_roots[j]);
    });
    group.each_lane([&] {
      load(_first, octets, low, high);
      transform_half<-1>(low, high, odd, half);
      constexpr QuarterCosines turn;
      for (int j = 0; j < 4; ++j) {
        const double cosine = odd ? turn.cosine[2 * j + 1] : turn.cosine[2 * j],
                     sine = odd ? turn.cosine[7 - 2 * j] : turn.cosine[8 - 2 * j];
        _row[place(2 * j + _odd)] = half[j].im * cosine - half[j].re * sine;
      }
    });
    return LaneNodes<4>::load_swizzled(_thread, _row);
  }

 private:
  static constexpr int octets = 16;

  /// Values of the first pass; the upper four are negated for odd elements.
  KOKKOS_INLINE_FUNCTION void real_halves(ComplexNumber<double> (&low)[4],
                                          ComplexNumber<double> (&high)[4]) const {
    constexpr QuarterCosines turn;
    low[0] = {_row[place(0)], 0.0};
    for (int m = 1; m < 4; ++m) {
      const double v = _row[place(m)];
      low[m] = {v * turn.cosine[m], v * turn.cosine[8 - m]};
    }
    for (int m = 4; m < 8; ++m) {
      const double v = _odd != 0 ? -_row[place(m)] : _row[place(m)];
      high[m - 4] = {v * turn.cosine[m], v * turn.cosine[8 - m]};
    }
  }
  /// Values of another pass, negated likewise.
  KOKKOS_INLINE_FUNCTION void load(const ComplexNumber<double>* from, int stride,
                                   ComplexNumber<double> (&low)[4], ComplexNumber<double> (&high)[4]) const {
    for (int m = 0; m < 4; ++m) {
      low[m] = from[padded(m * stride)];
      const ComplexNumber<double> other = from[padded((m + 4) * stride)];
      high[m] = _odd != 0 ? ComplexNumber<double>{-other.re, -other.im} : other;
    }
  }
  /// Index of node octet + 16 m in the row.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int m) const {
    return 2 * swizzled(_octet / 2 + octets / 2 * m) + _octet % 2;
  }

  int _thread, _octet, _odd;
  double* _row;
  ComplexNumber<double>*_first, *_second, *_third;
  ComplexNumber<double> _forward_roots[4], _inverse_roots[4], _last[2], _spectrum[4];
};

}  // namespace drogue::options
