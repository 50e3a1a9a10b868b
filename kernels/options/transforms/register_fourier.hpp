#pragma once

#include "kernels/options/transforms/fourier_sum.hpp"
#include "kernels/options/transforms/lane_nodes.hpp"

namespace drogue::options {

/// `sum_by_transforms` with one octet per lane in each pass: 256 = 8 x 8 x 4 on 32 lanes, 128 = 8 x 8 x 2 on
/// 16.
template <int lanes>
class RegisterFourier {
 public:
  /// `row` (mesh) and `z` (padded(mesh)) are shared memory, used exclusively from the first call on.
  KOKKOS_INLINE_FUNCTION RegisterFourier(int lane, const JumpSpectrum<double>& spectrum, double* row,
                                         ComplexNumber<double>* z)
      : _lane(lane),
        _roots(spectrum.roots),
        _spectrum(spectrum.values + padded(8 * lane)),
        _row(row),
        _first(z + padded(lane)),
        _second(z + padded(lane / radix * (8 * radix) + lane % radix)),
        _third(z + padded(8 * lane)) {
    if constexpr (in_registers) {
      _invariants.roots = spectrum.roots.seven(1, lane / radix);
      _invariants.spectrum.load(_spectrum, 1);
    }
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION LaneNodes<8> operator()(const ThreadGroup& group, const LaneNodes<8>& value) const {
    Octet<double> octet;
    group.each_lane([&] { value.store_swizzled(_lane, _row); });
    group.each_lane([&] {
      octet.forward_real([this](int m) { return _row[place(m)]; });
      octet.store(_first, lanes);
    });
    group.each_lane([&] {
      octet.load(_second, radix);
      octet.forward(second_roots());
      octet.store(_second, radix);
    });
    group.each_lane([&] {
      octet.load(_third, 1);
      octet.multiply_last<radix>(_roots, 2, _lane, own_spectrum());
      octet.store(_third, 1);
    });
    group.each_lane([&] {
      octet.load(_second, radix);
      octet.inverse(second_roots());
      octet.store(_second, radix);
    });
    group.each_lane([&] {
      octet.load(_first, lanes);
      octet.inverse_imaginary([this](int m, double y) { _row[place(m)] = y; });
    });
    return LaneNodes<8>::load_swizzled(_lane, _row);
  }

 private:
  static constexpr Passes passes{8 * lanes};
  static constexpr int radix = 1 << passes.last_log_radix;
  static_assert(passes.last == 2);
  static constexpr bool in_registers = keeps_spectrum(lanes);

  /// Values that do not change between steps.
  struct StepInvariants {
    SevenRoots roots;
    Octet<double> spectrum;
  };
  struct Empty {};

  [[nodiscard]] KOKKOS_INLINE_FUNCTION SevenRoots second_roots() const {
    if constexpr (in_registers) return _invariants.roots;
    return _roots.seven(1, _lane / radix);
  }
  /// The lane's eight values of the spectrum.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION const ComplexNumber<double>* own_spectrum() const {
    if constexpr (in_registers) return _invariants.spectrum.z;
    return _spectrum;
  }

  /// Index of node lane + lanes m in the row.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int m) const {
    return 2 * swizzled(_lane / 2 + lanes / 2 * m) + _lane % 2;
  }

  int _lane;
  FourierRoots _roots;
  const ComplexNumber<double>* _spectrum;  ///< part of the lane
  double* _row;
  ComplexNumber<double>*_first, *_second, *_third;
  std::conditional_t<in_registers, StepInvariants, Empty> _invariants;
};

}  // namespace drogue::options
