#pragma once

#include "kernels/options/batch/pide_pricer.hpp"

namespace drogue::options {

/// `PidePricer` behind the virtual interface, on an execution-space instance of its own.
template <class ExecutionSpace>
class PricerAdapter final : public Pricer {
 public:
  explicit PricerAdapter(const Settings& settings) : _instance(1 << 20), _pricer(_instance, settings) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) override {
    return _pricer.price(contracts, prices);
  }
  std::pmr::memory_resource& memory() override { return _pricer.memory(); }
  std::vector<BoundaryPoint> boundary(const Contract& contract, int mesh, int steps) override {
    return _pricer.boundary(contract, mesh, steps);
  }
  std::vector<ProfilePoint> profile(const Contract& contract) override { return _pricer.profile(contract); }

 private:
  device::Instance<ExecutionSpace> _instance;
  PidePricer<ExecutionSpace> _pricer;
};

template <class ExecutionSpace>
std::unique_ptr<Pricer> make_pide(const Settings& settings) {
  return std::make_unique<PricerAdapter<ExecutionSpace>>(settings);
}

}  // namespace drogue::options
