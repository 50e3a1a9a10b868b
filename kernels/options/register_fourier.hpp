#pragma once

#include "kernels/options/fourier_sum.hpp"
#include "kernels/options/lane_nodes.hpp"

namespace drogue::options {

/// `sum_by_transforms` for a mesh of 256, where every lane has one octet of each pass: 256 = 8 x 8 x 4.
class RegisterFourier {
 public:
  /// `row` (256) and `z` (padded(256)) are shared memory for it alone.
  KOKKOS_INLINE_FUNCTION RegisterFourier(int lane, const JumpSpectrum<double>& spectrum, double* row,
                                         ComplexNumber<double>* z)
      : _lane(lane),
        _roots(spectrum.roots),
        _second_roots(spectrum.roots.seven(1, lane / 4)),
        _row(row),
        _first(z + padded(lane)),
        _second(z + padded(lane / 4 * 32 + lane % 4)),
        _third(z + padded(8 * lane)) {
    _spectrum.load(spectrum.place + padded(8 * lane), 1);
  }

  KOKKOS_INLINE_FUNCTION LaneNodes<8> operator()(const WarpWorkers& workers,
                                                 const LaneNodes<8>& value) const {
    value.store_swizzled(_lane, _row);
    workers.meet();
    Octet<double> octet;
    octet.split_real([this](int m) { return _row[place(m)]; });
    octet.store(_first, 32);
    workers.meet();
    octet.load(_second, 4);
    octet.split(_second_roots);
    octet.store(_second, 4);
    workers.meet();
    octet.load(_third, 1);
    octet.multiply_last<4>(_roots, 2, _lane, _spectrum.z);
    octet.store(_third, 1);
    workers.meet();
    octet.load(_second, 4);
    octet.join(_second_roots);
    octet.store(_second, 4);
    workers.meet();
    octet.load(_first, 32);
    octet.join_imaginary([this](int m, double y) { _row[place(m)] = y; });
    workers.meet();
    return LaneNodes<8>::load_swizzled(_lane, _row);
  }

 private:
  /// Where node lane + 32 m is in the row.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int m) const {
    return 2 * swizzled(_lane / 2 + 16 * m) + _lane % 2;
  }

  int _lane;
  FourierRoots _roots;
  SevenRoots _second_roots;
  Octet<double> _spectrum;
  double* _row;
  ComplexNumber<double>*_first, *_second, *_third;
};

}  // namespace drogue::options
