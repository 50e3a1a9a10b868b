#include "miniapps/gas/scheme_names.hpp"

#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {

SchemeNames scheme_names(const gas::Parameters& p) {
  const char* const splittings[] = {"lf-global", "lf-single", "lf-stencil"};
  SchemeNames names;
  names.weno = weno_name(p.weno);
  names.splitting = splittings[static_cast<int>(p.splitting)];
  names.time = p.time_scheme == gas::TimeScheme::ssprk3 ? "ssprk3" : "ssprk43";
  names.precision = p.precision == gas::Precision::split ? "split" : "double";
  names.label = names.weno + (p.weno == gas::Weno::z && p.weno_power == 2 ? "2" : "");
  if (names.splitting != "lf-stencil") names.label += " " + names.splitting;
  if (names.time != "ssprk3") names.label += " " + names.time;
  if (names.precision != "double") names.label += " " + names.precision;
  return names;
}

}  // namespace drogue::gas_app
