#include "kernels/options/pricer.hpp"

#include <stdexcept>
#include <string>

#include "kernels/device/block_size.hpp"
#include "kernels/options/cos/pricer.hpp"

namespace drogue::options {

// Defined in batch/pricer_adapter.hpp and surface/surface_impl.hpp, instantiated for each backend in
// instances/.
template <class ExecutionSpace>
std::unique_ptr<Pricer> make_pide(const Settings& settings);
template <class ExecutionSpace>
std::unique_ptr<Pricer> make_surface(const Settings& settings, std::unique_ptr<Pricer> single);

namespace {

void require(bool holds, const char* condition) {
  if (!holds) throw std::invalid_argument(std::string("options pricer: ") + condition);
}

void require_valid(const Settings& s) {
  require(s.mesh == 0 || (s.mesh >= 32 && s.mesh <= 4096 && s.mesh % 2 == 0),
          "mesh must be 0 or an even number from 32 to 4096");
  require(s.steps == 0 || (s.steps >= 8 && s.steps <= 16384 && s.steps % 2 == 0),
          "steps must be 0 or an even number from 8 to 16384");
  require(s.tolerance > 0.0, "the tolerance must be positive");
  require(!s.single_grid || s.mesh != 0, "one grid states no error by which to choose a mesh");
  require(!s.surface || s.method == Method::pide, "a surface needs the method pide");
}

}  // namespace

std::unique_ptr<Pricer> create_pricer(device::Backend backend, const Settings& settings) {
  require(device::is_block_size(settings.block), "block must be a multiple of 32 between 32 and 512");
  if (settings.method == Method::cos && !settings.surface) return create_cos_pricer(backend, settings);
  require_valid(settings);
  return device::dispatch(backend, [&]<class ExecutionSpace>() {
    auto pide = make_pide<ExecutionSpace>(settings);
    return settings.surface ? make_surface<ExecutionSpace>(settings, std::move(pide)) : std::move(pide);
  });
}

}  // namespace drogue::options
