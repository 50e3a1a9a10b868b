#include "miniapps/parachute/canopy/canopy_keys.hpp"

#include "miniapps/parachute/bodies/body_keys.hpp"
#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Choices;
using scene::Table;

const Choices<CanopyKind> canopy_choices = {{"flat-circular", CanopyKind::flat_circular}};
const Choices<Fabric> cloth_choices = {{"mil-c-7020-1", Fabric::mil_c_7020_1}, {"custom", Fabric::custom}};
const Choices<CanopyShape> shape_choices = {{"flat", CanopyShape::flat},
                                            {"partly-closed", CanopyShape::partly_closed},
                                            {"angled-15", CanopyShape::angled_15},
                                            {"angled-60", CanopyShape::angled_60},
                                            {"angled-75", CanopyShape::angled_75}};

void declare_cloth(Table& table, Canopy& canopy) {
  table.value("cloth", scene::choice_codec(canopy.cloth, cloth_choices),
              "MIL-C-7020 type I, 0.0373 kg/m^2, or a given area density");
  table.value("area_density", scene::real_codec(canopy.area_density), "Mass per area of the cloth")
      .unit("kg/m^2")
      .above(0.0)
      .when([&canopy] { return canopy.cloth == Fabric::custom; }, "with cloth = \"custom\"", "cloth");
  table
      .value("membrane_modulus", scene::real_codec(canopy.membrane_modulus),
             "Young's modulus times thickness; the same for all canopies")
      .unit("N/m")
      .above(0.0);
  table.value("poisson", scene::real_codec(canopy.poisson), "Poisson's ratio; the same for all canopies")
      .range(-0.9, 0.5);
  table
      .value("edge_length", scene::real_codec(canopy.edge_length),
             "Largest edge along rings and meridians; at most a cell over 1.4, and half a cell for accuracy")
      .unit("m")
      .above(0.0)
      .required();
}

void declare_place(Table& table, Canopy& canopy) {
  table.value("shape", scene::choice_codec(canopy.shape, shape_choices),
              "Shape at the start: the flat cloth, a pleated cone, or the flat cloth with its axis 15, 60 or "
              "75 degrees from z");
  table.value("closure", scene::real_codec(canopy.closure), "Radius of the skirt over that of the flat cloth")
      .above(0.0)
      .at_most(1.0)
      .when([&canopy] { return canopy.shape == CanopyShape::partly_closed; },
            "with shape = \"partly-closed\"", "shape");
  table.value("angle", scene::real_codec(canopy.angle), "Angle of the axis from z towards x")
      .unit("degrees")
      .range(-180.0, 180.0)
      .when(
          [&canopy] {
            return canopy.shape == CanopyShape::flat || canopy.shape == CanopyShape::partly_closed;
          },
          "with shape = \"flat\" or \"partly-closed\"", "shape");
  table.value("centre", vector_codec(canopy.centre), "Centre of the skirt at the start").unit("m");
}

void declare_lines(Table& table, SuspensionLines& lines) {
  table
      .value("length", scene::real_codec(lines.length),
             "Length from the payload to the skirt; longer than the radius of the flat cloth")
      .unit("m")
      .above(0.0);
  table
      .value("stiffness", scene::real_codec(lines.stiffness),
             "Young's modulus times cross-section of each line; lines carry no compression")
      .unit("N")
      .above(0.0);
  table
      .value("line_density", scene::real_codec(lines.line_density),
             "Mass per length; half of it moves with the skirt, half with the payload")
      .unit("kg/m")
      .at_least(0.0);
}

void declare_reinforcement(Table& table, Reinforcement& bands) {
  const auto declare = [&](const char* name, double& stiffness, const std::string& where) {
    table
        .value(name, scene::real_codec(stiffness),
               "Young's modulus times cross-section of bands along " + where + "; 0: none")
        .unit("N")
        .at_least(0.0);
  };
  declare("seams", bands.seams, "the seams between gores, as far as the mesh resolves them");
  declare("skirt", bands.skirt, "the skirt");
  declare("vent", bands.vent, "the vent");
}

}  // namespace

void declare_canopy(Table& table, Canopy& canopy) {
  table.value("kind", scene::choice_codec(canopy.kind, canopy_choices), "A flat disk of cloth with a vent")
      .required();
  table.value("diameter", scene::real_codec(canopy.diameter), "Diameter of the flat cloth")
      .unit("m")
      .above(0.0);
  table.value("gores", scene::integer_codec(canopy.gores), "Number of gores, and of suspension lines")
      .range(3, 1000);
  table.value("vent", scene::real_codec(canopy.vent), "Diameter of the vent; 0: none")
      .unit("m")
      .at_least(0.0);
  declare_cloth(table, canopy);
  declare_place(table, canopy);
  table.table(
      "lines", [&](Table& lines) { declare_lines(lines, canopy.lines); },
      "Suspension lines from the payload to the skirt, one per gore; they exchange no force with the fluid");
  table.table(
      "payload",
      [&](Table& payload) {
        payload.value("mass", scene::real_codec(canopy.payload.mass), "Mass").unit("kg").above(0.0);
        payload.value("fixed", scene::boolean_codec(canopy.payload.fixed), "The payload does not move");
      },
      "Point mass where the lines meet");
  table.table(
      "reinforcement", [&](Table& bands) { declare_reinforcement(bands, canopy.reinforcement); },
      "Bands sewn on the cloth");
  table.table(
      "porosity", [&](Table& porosity) { declare_porosity(porosity, canopy.porosity); },
      "Flow through the cloth");
}

}  // namespace drogue::parachute_app
