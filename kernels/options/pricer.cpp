#include "kernels/options/pricer.hpp"

#include <stdexcept>
#include <string>

#include "kernels/options/cos_pricer.hpp"

namespace drogue::options {

#define DROGUE_DECLARE(backend)                                            \
  std::unique_ptr<Pricer> create_pide_##backend(const Settings& settings); \
  std::unique_ptr<Pricer> create_surface_##backend(const Settings& settings, std::unique_ptr<Pricer> single);
DROGUE_FOR_EACH_BACKEND(DROGUE_DECLARE)
#undef DROGUE_DECLARE

namespace {

void check(const Settings& s) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("options pricer: ") + what);
  };
  require(s.mesh == 0 || (s.mesh >= 32 && s.mesh <= 4096 && s.mesh % 2 == 0),
          "mesh must be 0 or an even number from 32 to 4096");
  require(s.steps == 0 || (s.steps >= 8 && s.steps <= 16384 && s.steps % 2 == 0),
          "steps must be 0 or an even number from 8 to 16384");
  require(s.tolerance > 0.0, "the tolerance must be positive");
  require(!s.one_grid || s.mesh != 0, "one grid states no error by which to choose a mesh");
  require(!s.surface || s.method == Method::pide, "a surface needs the method pide");
}

}  // namespace

std::unique_ptr<Pricer> create_pricer(device::Backend backend, const Settings& settings) {
  if (settings.method == Method::cos && !settings.surface) return create_cos_pricer(backend, settings);
  check(settings);
  switch (backend) {
#define DROGUE_CREATE(name)                                                                 \
  case device::Backend::name:                                                               \
    return settings.surface ? create_surface_##name(settings, create_pide_##name(settings)) \
                            : create_pide_##name(settings);
    DROGUE_FOR_EACH_BACKEND(DROGUE_CREATE)
#undef DROGUE_CREATE
    default:
      throw std::invalid_argument("options pricer: this build lacks the backend");
  }
}

}  // namespace drogue::options
