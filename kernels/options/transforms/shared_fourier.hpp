#pragma once

#include "kernels/options/pide/thread_group.hpp"
#include "kernels/options/transforms/fourier_sum.hpp"
#include "kernels/options/transforms/lane_nodes.hpp"

namespace drogue::options {

/// `RegisterFourier` of 128 nodes for all threads of one warp or of two, four nodes per thread of a warp. 2
/// `warps` threads share an octet, and each computes 4/`warps` of its elements: half of the threads the even
/// elements, the others the odd ones. The thread that computes an element also multiplies it by the root of
/// the next pass. Where there is no root the factor is {1, 0}, which can only change the sign of a zero. With
/// two warps each of them holds all values and gets all sums; passes alternate between the memories of both,
/// so that a barrier follows each pass but none precedes it.
template <int warps>
class SharedFourier {
 public:
  /// `row` (mesh) is shared memory of the warp; `sums` (mesh) and `z` (padded(mesh)) are common to all warps,
  /// and so is `other_z`, which is `z` for one warp. They are used exclusively during a call. All warps have
  /// constructed before the first call.
  KOKKOS_INLINE_FUNCTION SharedFourier(const MarchingWarp<warps>& warp, const JumpSpectrum<double>& spectrum,
                                       double* row, double* sums, ComplexNumber<double>* z,
                                       ComplexNumber<double>* other_z)
      : _warp(warp),
        _octet(warp.thread % octets),
        _share((warp.index * max_lanes + warp.thread) / octets),
        _row(row),
        _sums(sums),
        _first(z + padded(_octet)),
        _second(z + padded(_octet / 2 * 16 + _octet % 2)),
        _second_out(other_z + padded(_octet / 2 * 16 + _octet % 2)) {
    const int m = _octet / 2;  // index of the element in its octet of the second pass
    for (int k = 0; k < own; ++k) {
      const int q = element(k);
      _forward_roots[k] = m > 0 ? spectrum.roots.at(1, m, q) : ComplexNumber<double>{1.0, 0.0};
      _inverse_roots[k] = q > 0 ? spectrum.roots.at(1, q, _octet / 2) : ComplexNumber<double>{1.0, 0.0};
    }
    const int first_pair = pairs * (warp.index * max_lanes + warp.thread);
    _third = other_z + padded(2 * first_pair);
    for (int k = 0; k < pairs; ++k) _last[k] = spectrum.roots.at(2, 4, first_pair + k);
    for (int k = 0; k < 2 * pairs; ++k) _spectrum[k] = spectrum.values[padded(2 * first_pair) + k];
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION LaneNodes<4> operator()(const ThreadGroup& group, const LaneNodes<4>& value) const {
    ComplexNumber<double> low[4], high[4], out[own];
    group.each_lane([&] { value.store_swizzled(_warp.thread, _row); });
    real_halves(low, high);
    transform_own<1>(low, high, out);
    for (int k = 0; k < own; ++k) _first[padded(octets * element(k))] = product(out[k], _forward_roots[k]);
    _warp.sync_march();
    load(_second, 2, low, high);
    sync_in_place();
    transform_own<1>(low, high, out);
    for (int k = 0; k < own; ++k) _second_out[padded(2 * element(k))] = out[k];
    _warp.sync_march();
    for (int k = 0; k < pairs; ++k) {
      ComplexNumber<double> z[2] = {_third[2 * k], product(_third[2 * k + 1], _last[k])};
      transform<1>(z[0], z[1]);
      for (int m = 0; m < 2; ++m) z[m] = product(z[m], _spectrum[2 * k + m]);
      transform<-1>(z[0], z[1]);
      _third[2 * k] = z[0];
      _third[2 * k + 1] = times_conjugate(z[1], _last[k]);
    }
    _warp.sync_march();
    load(_second_out, 2, low, high);
    sync_in_place();
    transform_own<-1>(low, high, out);
    for (int k = 0; k < own; ++k)
      _second[padded(2 * element(k))] = times_conjugate(out[k], _inverse_roots[k]);
    _warp.sync_march();
    load(_first, octets, low, high);
    transform_own<-1>(low, high, out);
    store_imaginary(out);
    _warp.sync_march();
    return LaneNodes<4>::load_swizzled(_warp.thread, _sums);
  }

 private:
  /// Elements of an octet and pairs of the last pass per thread.
  static constexpr int octets = 16, own = 4 / warps, pairs = 2 / warps;
  static_assert(warps == 1 || warps == 2);

  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool is_odd() const { return _share % 2 != 0; }
  /// Index of the thread's k-th element in its octet.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int element(int k) const {
    return 2 * (_share / 2 + k * warps) + _share % 2;
  }
  /// Between the loads and the stores of a pass in place.
  KOKKOS_INLINE_FUNCTION void sync_in_place() const {
    if constexpr (warps == 1) _warp.sync_march();
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static ComplexNumber<double> negated_if(
      bool condition, const ComplexNumber<double>& z) {
    return condition ? ComplexNumber<double>{-z.re, -z.im} : z;
  }

  /// The thread's elements of `transform` of eight values, with the same operations.
  template <int sign>
  KOKKOS_INLINE_FUNCTION void transform_own(const ComplexNumber<double> (&low)[4],
                                            const ComplexNumber<double> (&high)[4],
                                            ComplexNumber<double> (&out)[own]) const {
    const bool odd = is_odd();
    const auto either = [odd](const ComplexNumber<double>& if_odd, const ComplexNumber<double>& if_even) {
      return ComplexNumber<double>{odd ? if_odd.re : if_even.re, odd ? if_odd.im : if_even.im};
    };
    const double scale = odd ? 0.70710678118654752440 : 1.0;
    ComplexNumber<double> z[4];
    for (int m = 0; m < 4; ++m) z[m] = low[m] + high[m];
    const ComplexNumber<double> second = either(times_i<sign>(z[2]), z[2]),
                                first = either(z[1] + times_i<sign>(z[1]), z[1]),
                                third = either(times_i<sign>(z[3]) - z[3], z[3]);
    for (int k = 0; k < own / 2; ++k) {
      const bool turned = warps == 1 ? k == 1 : _share / 2 == 1;
      const ComplexNumber<double> base = z[0] + negated_if(turned, second),
                                  sum = first + negated_if(turned, third), turned_sum = times_i<sign>(sum);
      const ComplexNumber<double> other = {scale * (turned ? turned_sum.re : sum.re),
                                           scale * (turned ? turned_sum.im : sum.im)};
      out[k] = base + other;
      out[k + own / 2] = base - other;
    }
  }
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
      const double v = is_odd() ? -_row[place(m)] : _row[place(m)];
      high[m - 4] = {v * turn.cosine[m], v * turn.cosine[8 - m]};
    }
  }
  /// Values of another pass, negated likewise.
  KOKKOS_INLINE_FUNCTION void load(const ComplexNumber<double>* from, int stride,
                                   ComplexNumber<double> (&low)[4], ComplexNumber<double> (&high)[4]) const {
    for (int m = 0; m < 4; ++m) {
      low[m] = from[padded(m * stride)];
      high[m] = negated_if(is_odd(), from[padded((m + 4) * stride)]);
    }
  }
  /// Stores the sums, imaginary parts after the last root.
  KOKKOS_INLINE_FUNCTION void store_imaginary(const ComplexNumber<double> (&out)[own]) const {
    constexpr QuarterCosines turn;
    for (int k = 0; k < own; ++k) {
      double cosine = 0.0, sine = 0.0;
      for (int q = 2 * k * warps; q < 2 * (k + 1) * warps; ++q) {  // no array that is indexed at run time
        if (q == element(k)) cosine = turn.cosine[q], sine = turn.cosine[8 - q];
      }
      _sums[place(element(k))] = out[k].im * cosine - out[k].re * sine;
    }
  }
  /// Index of node octet + 16 m in the row.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int m) const {
    return 2 * swizzled(_octet / 2 + octets / 2 * m) + _octet % 2;
  }

  MarchingWarp<warps> _warp;
  int _octet, _share;  ///< _share: which of the 2 warps threads of the octet
  double *_row, *_sums;
  ComplexNumber<double>*_first, *_second, *_second_out, *_third;
  ComplexNumber<double> _forward_roots[own], _inverse_roots[own], _last[pairs], _spectrum[2 * pairs];
};

}  // namespace drogue::options
