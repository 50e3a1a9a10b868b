#pragma once

#include "kernels/gas/solver.hpp"
#include "kernels/gas/stepping/launch.hpp"
#include "perf/raw/cuda_pair.hpp"
#include "perf/raw/gas_step.hpp"

namespace drogue::perf::raw {

/// `gas::StepFunctor` and `launch_gas_step`.
class GasPair final : public CudaPair {
 public:
  explicit GasPair(const GasProblem& problem) : _problem(problem) {
    gas::Parameters p = problem.parameters;
    p.driver = gas::Driver::graph;  // the tiles of the fused step that has a launch of its own
    const gas::Tiling tiling = gas::create_solver(device::Backend::cuda, p)->tiling();
    _cells = static_cast<std::size_t>(p.cells);
    _setup.table = gas::stage_table(p.time_scheme);
    _setup.boundaries = {p.cells, p.left, p.right};
    const auto tile_cells = static_cast<int>(tiling.cells);
    _setup.step_shape = {tile_cells, tiling.halo, tile_cells + 2 * tiling.halo};
    _setup.team_size = gas::device_team(p.block, p.cells);
    _setup.gamma = p.gamma;
    _setup.dx = (p.x_max - p.x_min) / static_cast<double>(p.cells);
    _setup.splitting = p.splitting;
    _setup.average = p.face_average;
    _step = {.buffer = {},
             .control = _raw_control.data(),
             .stage = {},
             .stages = _setup.table.stages,
             .cells = p.cells,
             .left = static_cast<int>(p.left),
             .right = static_cast<int>(p.right),
             .average = static_cast<int>(p.face_average),
             .gamma = p.gamma,
             .inverse_dx = 1.0 / _setup.dx,
             .tile_cells = tile_cells,
             .halo = tiling.halo,
             .slots = _setup.step_shape.stride,
             .threads = _setup.team_size};
    for (std::size_t k = 0; k < 3; ++k) {
      _setup.buffer[k] = Fields("drogue::perf::raw::gas", _cells);
      _raw_buffer[k] = Fields("drogue::perf::raw::gas_raw", _cells);
      _step.buffer[k] = _raw_buffer[k].data();
    }
    _setup.control = decltype(_setup.control)("drogue::perf::raw::gas_control");
    for (int k = 0; k < _setup.table.stages; ++k)
      _step.stage[k] = {_setup.table.stage[k].share, _setup.table.stage[k].dt_factor,
                        _setup.table.stage[k].out};
    _result = static_cast<std::size_t>(_setup.table.stage[_setup.table.stages - 1].out);
  }

  void reset(Version version) override {
    const bool is_raw = version == Version::hand_written;
    const auto& buffer = is_raw ? _raw_buffer : _setup.buffer;
    for (std::size_t k = 1; k < 3; ++k) Kokkos::deep_copy(space(), buffer[k], 0.0);
    std::vector<double> start;
    for (const std::vector<double>& field : _problem.fields)
      start.insert(start.end(), field.begin(), field.end());
    to_device(buffer[0], start.data(), start.size());
    if (is_raw) {
      GasControl control{};
      control.dt = _problem.dt;
      control.first_inadmissible = gas::no_failure;
      to_device(_raw_control, &control, 1);
    } else {
      gas::Control control{};
      control.trial.dt = _problem.dt;
      control.trial.stop = gas::Stop::running;
      control.reduction.first_inadmissible = gas::no_failure;
      to_device(_setup.control, &control, 1);
    }
  }

  [[nodiscard]] int block() const override { return _setup.team_size; }
  [[nodiscard]] std::int64_t cells() const override { return _setup.boundaries.cells; }

 private:
  using Fields = gas::FieldsView<Kokkos::Cuda>;

  void enqueue(Version version) override {
    if (version == Version::hand_written)
      launch_gas_step(_step, instance().stream());
    else
      gas::launch_step<gas::Reconstruction::js>(space(), _setup, gas::Precision::full, false);
  }

  /// Fields, largest wave speed, and 1 in place of 0 for an inadmissible cell.
  [[nodiscard]] Results read(Version version) override {
    const bool is_raw = version == Version::hand_written;
    const std::vector<double> all =
        to_host(is_raw ? _raw_buffer[_result] : _setup.buffer[_result], 3 * _cells);
    Results results;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(k * _cells);
      results.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(_cells));
    }
    std::uint64_t speed = 0, inadmissible = 0;
    if (is_raw) {
      GasControl control{};
      device::copy_out(space(), &control, _raw_control, 1);
      space().fence("drogue::perf::raw: control read");
      speed = control.speed, inadmissible = control.first_inadmissible;
    } else {
      gas::Control control{};
      device::copy_out(space(), &control, _setup.control, 1);
      space().fence("drogue::perf::raw: control read");
      speed = control.reduction.stage_speed[_setup.table.stages][2];
      inadmissible = control.reduction.first_inadmissible;
    }
    results.push_back({Kokkos::bit_cast<double>(speed)});
    results.push_back({inadmissible == gas::no_failure ? 0.0 : 1.0});
    return results;
  }

  GasProblem _problem;
  std::size_t _cells = 0, _result = 0;
  gas::StageSetup<Kokkos::Cuda> _setup;
  Fields _raw_buffer[3];
  Kokkos::View<GasControl, Kokkos::CudaSpace> _raw_control{"drogue::perf::raw::gas_raw_control"};
  GasStep _step{};
};

}  // namespace drogue::perf::raw
