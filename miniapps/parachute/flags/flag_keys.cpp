#include "miniapps/parachute/flags/flag_keys.hpp"

#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {

void declare_flag(scene::Table& table, Flag& flag) {
  table.value("leading_edge", pair_codec(flag.leading_edge), "Its place in x and y, where the flag is hinged")
      .unit("m")
      .required();
  table.value("length", scene::real_codec(flag.length), "Length").unit("m").above(0.0).required();
  table
      .value("angle", scene::real_codec(flag.angle),
             "Angle from x towards y at the start, where the flag is straight")
      .unit("degrees")
      .range(-180.0, 180.0);
  table.value("area_density", scene::real_codec(flag.area_density), "Mass per area")
      .unit("kg/m^2")
      .above(0.0)
      .required();
  table
      .value("bending_stiffness", scene::real_codec(flag.bending_stiffness),
             "Bending moment per width over curvature; the same for all flags")
      .unit("N m")
      .at_least(0.0)
      .required();
  table
      .value("membrane_modulus", scene::real_codec(flag.membrane_modulus),
             "Young's modulus times thickness; the same for all flags")
      .unit("N/m")
      .above(0.0);
  table
      .value("edge_length", scene::real_codec(flag.edge_length),
             "Largest edge along and across the flag; at most a cell over 1.4, and half a cell for accuracy")
      .unit("m")
      .above(0.0)
      .required();
  table
      .value("width", scene::real_codec(flag.width),
             "Extent along z; required where the grid has several cells along z, else not allowed")
      .unit("m")
      .above(0.0)
      .default_text("that of the domain, of one cell along z");
  table.value("middle", scene::real_codec(flag.middle), "Place of the middle of the width along z")
      .unit("m")
      .when([&flag] { return flag.has_width(); }, "with a width", "width");
}

}  // namespace drogue::parachute_app
