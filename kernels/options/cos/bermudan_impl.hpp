#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/options/cos/backward_induction.hpp"

namespace drogue::options {

/// Prices Bermudan puts with the same number of cosines, one team per put.
template <class ExecutionSpace>
struct PriceBermudansFunctor {
  using Memory = typename ExecutionSpace::memory_space;
  using Team = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, Memory>::accessible);

  Kokkos::View<const BermudanPut*, Memory> puts;
  Kokkos::View<const double*, Memory> psi_re, psi_im, roots_re, roots_im;
  Kokkos::View<double*, Memory> workspace;
  Kokkos::View<BermudanValue*, Memory> values;
  int first, log_terms;

  KOKKOS_FUNCTION void operator()(const Team& team) const {
    const BermudanPut put = puts(first + team.league_rank());
    double* const memory =
        workspace.data() + static_cast<std::size_t>(team.league_rank()) * CosWorkspace::size(log_terms);
    const BackwardInduction<Team> induction(team, put, {psi_re.data() + put.table, psi_im.data() + put.table},
                                            {roots_re.data(), roots_im.data()}, max_log_terms + 1, memory);
    const BermudanValue value = induction.solve();
    Kokkos::single(Kokkos::PerTeam(team), [&] { values(first + team.league_rank()) = value; });
  }
};

/// `BermudanSolver` on an execution space.
template <class ExecutionSpace>
class BermudanSolverImpl final : public BermudanSolver {
  using Memory = typename ExecutionSpace::memory_space;
  template <class Value>
  using View = Kokkos::View<Value*, Memory>;
  template <class Value>
  using HostView = Kokkos::View<Value*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

 public:
  explicit BermudanSolverImpl(int block) : _instance(ExecutionSpace().concurrency()), _block(block) {
    constexpr int count = 1 << max_log_terms;  // the transforms use half of the roots
    std::vector<double> re(count), im(count);
    for (int k = 0; k < count; ++k) {
      re[k] = std::cos(std::numbers::pi * k / count);
      im[k] = std::sin(std::numbers::pi * k / count);
    }
    _roots_re = to_device<double>("drogue::options::roots_re", re);
    _roots_im = to_device<double>("drogue::options::roots_im", im);
    _instance.space().fence("drogue::options::cos: roots");
  }

  void solve(std::span<const BermudanPut> puts, std::span<const double> psi_re,
             std::span<const double> psi_im, std::span<BermudanValue> values) override {
    if (puts.empty()) return;
    const auto& space = _instance.space();
    PriceBermudansFunctor<ExecutionSpace> kernel{
        .puts = to_device("drogue::options::puts", puts),
        .psi_re = to_device("drogue::options::psi_re", psi_re),
        .psi_im = to_device("drogue::options::psi_im", psi_im),
        .roots_re = _roots_re,
        .roots_im = _roots_im,
        .workspace = {},
        .values = View<BermudanValue>("drogue::options::bermudans", puts.size()),
        .first = 0,
        .log_terms = 0};
    const int count = static_cast<int>(puts.size());
    for (kernel.first = 0; kernel.first < count;) {
      kernel.log_terms = puts[kernel.first].log_terms;
      int last = kernel.first;
      while (last < count && puts[last].log_terms == kernel.log_terms) ++last;
      launch(kernel, std::min(last - kernel.first, max_puts_per_launch(kernel.log_terms)));
    }
    device::copy(space, HostView<BermudanValue>(values.data(), values.size()), kernel.values);
    space.fence("drogue::options::cos: values");
  }

 private:
  /// Bounds the workspace to 2^25 doubles.
  static int max_puts_per_launch(int log_terms) { return (1 << 25) / CosWorkspace::size(log_terms); }

  void launch(PriceBermudansFunctor<ExecutionSpace>& kernel, int count) {
    const std::size_t size = static_cast<std::size_t>(count) * CosWorkspace::size(kernel.log_terms);
    if (_workspace.size() < size) {
      _instance.space().fence("drogue::options::cos: workspace");
      _workspace = {};
      _workspace = View<double>(
          Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string("drogue::options::workspace")), size);
    }
    kernel.workspace = _workspace;
    using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
    const bool is_chosen = _block > 0 && !device::is_host<ExecutionSpace>;
    Kokkos::parallel_for(
        "drogue::options::value_bermudans",
        is_chosen ? Policy(_instance.space(), count, _block) : Policy(_instance.space(), count, Kokkos::AUTO),
        kernel);
    kernel.first += count;
  }

  template <class Value>
  View<const std::remove_const_t<Value>> to_device(const std::string& label, std::span<Value> from) const {
    using Plain = std::remove_const_t<Value>;
    const View<Plain> to(Kokkos::view_alloc(Kokkos::WithoutInitializing, label), from.size());
    device::copy(_instance.space(), to, HostView<const Plain>(from.data(), from.size()));
    return to;
  }

  device::Instance<ExecutionSpace> _instance;
  View<const double> _roots_re, _roots_im;
  View<double> _workspace;
  int _block;
};

template <class ExecutionSpace>
std::unique_ptr<BermudanSolver> make_bermudan_solver(int block) {
  return std::make_unique<BermudanSolverImpl<ExecutionSpace>>(block);
}

}  // namespace drogue::options
