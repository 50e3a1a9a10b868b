#pragma once

#include "kernels/gas/tile/tile_update.hpp"

namespace drogue::gas {

/// Sliding window over the stencils of consecutive faces, for a device thread in split precision. The next
/// face costs five differences and conversions instead of twenty-five. In full precision the window would
/// exceed the register budget.
template <class N, class Tile>
class SlidingStencil {
 public:
  using Value = double;

  ConservedVector<N> d_state[5];
  N d_flux_m[5], d_flux_energy[5];

  /// Positions the window before `face`; the first `advance` moves to it.
  KOKKOS_FUNCTION SlidingStencil(const Tile& tile, int face) : _tile(tile), _face(face - 1) {
    load(_values, face);
    load_speeds(face);
    for (int k = 1; k < 5; ++k) push(face + k);
  }

  /// Moves to the next face.
  KOKKOS_FUNCTION void advance() {
    ++_face;
    push(_face + 5);
  }

  [[nodiscard]] KOKKOS_FUNCTION WaveSpeeds<N> wave_speeds() const {
    const auto fastest = [](const N(&speed)[6]) {
      return device::maximum(
          device::maximum(device::maximum(speed[0], speed[1]), device::maximum(speed[2], speed[3])),
          device::maximum(speed[4], speed[5]));
    };
    return {fastest(_slow), fastest(_entropy), fastest(_fast)};
  }

  /// Central flux in double precision. Reloads its values, because registers are scarcer than loads here.
  [[nodiscard]] KOKKOS_FUNCTION ConservedVector<double> central() const {
    const auto of = [&](TileField field) {
      const auto value = [&](int k) { return _tile.template load<double>(field, _face + k); };
      return central_flux(value(2) + value(3), value(2) - value(1), value(4) - value(3));
    };
    return {of(TileField::m), of(TileField::flux_m), of(TileField::flux_energy)};
  }

 private:
  using To = device::Convert<N>;

  KOKKOS_FUNCTION void load(double (&values)[5], int slot) const {
    values[0] = _tile.template load<double>(TileField::rho, slot);
    values[1] = _tile.template load<double>(TileField::m, slot);
    values[2] = _tile.template load<double>(TileField::energy, slot);
    values[3] = _tile.template load<double>(TileField::flux_m, slot);
    values[4] = _tile.template load<double>(TileField::flux_energy, slot);
  }
  /// Conversion is monotone: the maximum of converted values is the converted maximum.
  KOKKOS_FUNCTION void load_speeds(int slot) {
    _slow[5] = To::from(_tile.template load<double>(TileField::slow, slot));
    _entropy[5] = To::from(device::absolute(_tile.template load<double>(TileField::u, slot)));
    _fast[5] = To::from(_tile.template load<double>(TileField::fast, slot));
  }
  KOKKOS_FUNCTION void push(int slot) {
    for (int k = 0; k < 4; ++k) {
      d_state[k] = d_state[k + 1];
      d_flux_m[k] = d_flux_m[k + 1], d_flux_energy[k] = d_flux_energy[k + 1];
    }
    for (int k = 0; k < 5; ++k)
      _slow[k] = _slow[k + 1], _entropy[k] = _entropy[k + 1], _fast[k] = _fast[k + 1];
    double now[5];
    load(now, slot);
    load_speeds(slot);
    const auto difference = [&](int k) { return To::from(now[k] - _values[k]); };
    d_state[4] = {difference(0), difference(1), difference(2)};
    d_flux_m[4] = difference(3), d_flux_energy[4] = difference(4);
    for (int k = 0; k < 5; ++k) _values[k] = now[k];
  }

  const Tile& _tile;
  int _face;
  double _values[5];  ///< values of the last slot, in the order of TileField
  N _slow[6], _entropy[6], _fast[6];
};

}  // namespace drogue::gas
