#pragma once

#include "kernels/options/fourier_sum.hpp"
#include "kernels/options/lane_nodes.hpp"

namespace drogue::options {

/// `sum_by_transforms` where every lane has one octet of each pass: 256 = 8 x 8 x 4 on 32 lanes, 128 = 8 x 8
/// x 2 on 16.
template <int lanes>
class RegisterFourier {
 public:
  /// `row` (mesh) and `z` (padded(mesh)) are shared memory for it alone from its first call on.
  KOKKOS_INLINE_FUNCTION RegisterFourier(int lane, const JumpSpectrum<double>& spectrum, double* row,
                                         Complex<double>* z)
      : _lane(lane),
        _roots(spectrum.roots),
        _second_roots(spectrum.roots.seven(1, lane / radix)),
        _row(row),
        _first(z + padded(lane)),
        _second(z + padded(lane / radix * (8 * radix) + lane % radix)),
        _third(z + padded(8 * lane)) {
    _spectrum.load(spectrum.place + padded(8 * lane), 1);
  }

  template <class Workers>
  KOKKOS_INLINE_FUNCTION LaneNodes<8> operator()(const Workers& workers, const LaneNodes<8>& value) const {
    value.store_swizzled(_lane, _row);
    workers.meet();
    Octet<double> octet;
    octet.split_real([this](int m) { return _row[place(m)]; });
    octet.store(_first, lanes);
    workers.meet();
    octet.load(_second, radix);
    octet.split(_second_roots);
    octet.store(_second, radix);
    workers.meet();
    octet.load(_third, 1);
    octet.multiply_last<radix>(_roots, 2, _lane, _spectrum.z);
    octet.store(_third, 1);
    workers.meet();
    octet.load(_second, radix);
    octet.join(_second_roots);
    octet.store(_second, radix);
    workers.meet();
    octet.load(_first, lanes);
    octet.join_imaginary([this](int m, double y) { _row[place(m)] = y; });
    workers.meet();
    return LaneNodes<8>::load_swizzled(_lane, _row);
  }

 private:
  static constexpr Passes passes{8 * lanes};
  static constexpr int radix = 1 << passes.last_log_radix;
  static_assert(passes.last == 2);

  /// Where node lane + lanes m is in the row.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int m) const {
    return 2 * swizzled(_lane / 2 + lanes / 2 * m) + _lane % 2;
  }

  int _lane;
  FourierRoots _roots;
  SevenRoots _second_roots;
  Octet<double> _spectrum;
  double* _row;
  Complex<double>*_first, *_second, *_third;
};

}  // namespace drogue::options
