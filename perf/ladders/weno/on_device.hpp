#pragma once

#include "kernels/device/launch.hpp"
#include "kernels/gas/stepping/stage_table.hpp"
#include "perf/ladders/weno/direct_flux.hpp"
#include "perf/ladders/weno/weno_rung.hpp"

namespace drogue::perf::ladder {

/// Stage update of a value: out = U^n + share (in - dt/dx (difference of its fluxes) - U^n).
template <class ExecutionSpace>
struct UpdateFunctor {
  Fields<ExecutionSpace> start, in, out, flux;
  double dt_over_dx, share;

  KOKKOS_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k)
      out(i, k) = start(i, k) + share * (in(i, k) + dt_over_dx * (flux(i, k) - flux(i + 1, k)) - start(i, k));
  }
};

/// Runs with a kernel for the fluxes and one for the update.
template <class ExecutionSpace>
class OnDeviceRung final : public WenoRung<ExecutionSpace> {
  using Base = WenoRung<ExecutionSpace>;

 public:
  explicit OnDeviceRung(const WenoProblem& problem)
      : Base(problem), _flux("drogue::perf::ladder::flux", this->size() + 1) {}

 protected:
  void step() override {
    constexpr gas::StageTable table = gas::stage_table(gas::TimeScheme::ssprk3);
    for (int s = 0; s < table.stages; ++s) {
      const gas::StageWeights& w = table.stage[s];
      const auto& in = this->buffer(w.in);
      launch_tiles(this->space(), "drogue::perf::ladder::on_device_flux", this->problem().cells(),
                   FluxFunctor<ExecutionSpace>{in, _flux, this->problem().gamma()});
      device::launch_each(this->space(), "drogue::perf::ladder::on_device_update",
                          static_cast<int>(this->size()),
                          UpdateFunctor<ExecutionSpace>{.start = this->buffer(0),
                                                        .in = in,
                                                        .out = this->buffer(w.out),
                                                        .flux = _flux,
                                                        .dt_over_dx = this->problem().dt_over_dx(),
                                                        .share = w.share});
    }
    this->advance_buffers(table.stage[table.stages - 1].out);
  }

 private:
  Fields<ExecutionSpace> _flux;  ///< (cells + 1, 3)
};

/// Rung 2. The state stays on the device; a second small kernel updates it.
///
/// Prediction: no copies, six launches per step. Per stage the flux kernel reads the state and writes the
/// fluxes, the update reads both and U^n and writes the state: 18 numbers per cell.
template <class ExecutionSpace>
Rung on_device_rung(const Shared<WenoProblem>& problem) {
  return make_rung<OnDeviceRung<ExecutionSpace>>(
      RungText{"on-device", "The state stays on the device; a second kernel updates it.",
               "On a host 1.06 to 1.18 times as fast: there were no real copies to save, and the caches "
               "hold the fluxes that the model fetches from memory. The rung pays off on a GPU."},
      stage_work(*problem, 2, 18, DirectFlux::arithmetic), problem);
}

}  // namespace drogue::perf::ladder
