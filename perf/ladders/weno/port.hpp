#pragma once

#include "perf/ladders/weno/direct_flux.hpp"
#include "perf/ladders/weno/weno_rung.hpp"

namespace drogue::perf::ladder {

/// Runs whose state is on the host.
template <class ExecutionSpace>
class PortRung final : public WenoRung<ExecutionSpace> {
  using Base = WenoRung<ExecutionSpace>;

 public:
  explicit PortRung(const WenoProblem& problem)
      : Base(problem),
        _device_flux("drogue::perf::ladder::flux", this->size() + 1),
        _state(3 * this->size()),
        _flux(3 * (this->size() + 1)) {}

  void reset() override {
    _state.clear();
    for (const auto& values : this->problem().start)
      _state.insert(_state.end(), values.begin(), values.end());
  }

  [[nodiscard]] double error() override {
    sod::Fields got;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto begin = _state.begin() + static_cast<std::ptrdiff_t>(k * this->size());
      got[k].assign(begin, begin + static_cast<std::ptrdiff_t>(this->size()));
    }
    return difference(this->problem(), got);
  }

 protected:
  void step() override {
    const std::size_t n = this->size();
    const std::vector<double> start = _state;
    for (const double share : {1.0, 0.25, 2.0 / 3.0}) {
      const auto& up = this->buffer(0);
      device::copy_in(this->space(), up, _state.data(), _state.size());
      launch_tiles(this->space(), "drogue::perf::ladder::port", this->problem().cells(),
                   FluxFunctor<ExecutionSpace>{up, _device_flux, this->problem().gamma()});
      device::copy_out(this->space(), _flux.data(), _device_flux, _flux.size());
      this->space().fence("drogue::perf::ladder: fluxes are on the host");
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < n; ++i) {
          const double* flux = _flux.data() + k * (n + 1) + i;
          double& u = _state[k * n + i];
          u = start[k * n + i] +
              share * (u + this->problem().dt_over_dx() * (flux[0] - flux[1]) - start[k * n + i]);
        }
    }
  }

 private:
  Fields<ExecutionSpace> _device_flux;
  std::vector<double> _state, _flux;  ///< on the host: three rows each
};

/// Rung 1. The port of a CPU code that [Shi], section 4.4.2, describes: only the costly loop runs on the
/// device. Each stage copies the state up, computes the fluxes from tiles in scratch memory, copies them
/// down, and the host updates the cells.
///
/// Prediction: per step three launches, six copies of three numbers per cell, and the arithmetic of three
/// stages. The update on the host, a few operations per cell, is taken for free.
template <class ExecutionSpace>
Rung port_rung(const Shared<WenoProblem>& problem) {
  Work work = stage_work(*problem, 1, 6, DirectFlux::arithmetic);
  work.copies = 6;
  work.copied_bytes = 3 * 48.0 * static_cast<double>(problem->cells());
  return make_rung<PortRung<ExecutionSpace>>(
      RungText{"port", "Only the costly loop runs on the device: state up, fluxes down, at every stage.",
               "On a host the copies are memcpy and cost next to nothing, and all takes 1.11 to 1.20 "
               "times the prediction: the long sums of the direct form hide most waiting. On a GPU the "
               "copies are most of the time (docs/gas-notebook.md, transfers)."},
      work, problem);
}

}  // namespace drogue::perf::ladder
