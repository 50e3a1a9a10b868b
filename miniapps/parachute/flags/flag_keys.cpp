#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {

using scene::positive;

void declare_flag(scene::Table& table, Flag& flag) {
  table.value("leading_edge", flag.leading_edge, "Its place in x and y, where the flag is hinged",
              {.unit = "m", .required = true});
  table.value("length", flag.length, "Length", {.unit = "m", .range = positive, .required = true});
  table.value("angle", flag.angle, "Angle from x towards y at the start, where the flag is straight",
              {.unit = "degrees", .range = scene::between(-180.0, 180.0)});
  table.value("area_density", flag.area_density, "Mass per area",
              {.unit = "kg/m^2", .range = positive, .required = true});
  table.value("bending_stiffness", flag.bending_stiffness,
              "Bending moment per width over curvature; the same for all flags",
              {.unit = "N m", .range = scene::not_negative, .required = true});
  table.value("membrane_modulus", flag.membrane_modulus,
              "Young's modulus times thickness; the same for all flags", {.unit = "N/m", .range = positive});
  table.value("edge_length", flag.edge_length,
              "Largest edge along and across the flag; at most a cell over 1.4, and half a cell for accuracy",
              {.unit = "m", .range = positive, .required = true});
  table.value("width", flag.width,
              "Extent along z; required where the grid has several cells along z, else not allowed",
              {.unit = "m", .range = positive, .default_text = "that of the domain, of one cell along z"});
  table.value("middle", flag.middle, "Place of the middle of the width along z",
              {.unit = "m", .when = {[&flag] { return flag.has_width(); }, "with a width", "width"}});
}

}  // namespace drogue::parachute_app
