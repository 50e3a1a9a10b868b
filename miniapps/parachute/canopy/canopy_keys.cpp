#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {
namespace {

using scene::between, scene::ChoiceKey, scene::Choices, scene::Condition, scene::not_negative,
    scene::positive, scene::Table;

using enum CanopyKind;
using enum CanopyShape;

const Choices<CanopyKind> canopy_choices = {{"flat-circular", flat_circular},
                                            {"extended-skirt", extended_skirt},
                                            {"guide-surface", guide_surface},
                                            {"sheet", sheet},
                                            {"drum", drum}};
const Choices<Fabric> cloth_choices = {{"mil-c-7020-1", Fabric::mil_c_7020_1}, {"custom", Fabric::custom}};
const Choices<CanopyShape> shape_choices = {{"flat", flat},
                                            {"partly-closed", partly_closed},
                                            {"angled-15", angled_15},
                                            {"angled-60", angled_60},
                                            {"angled-75", angled_75}};

/// Stiffness of a spring without compression. `of_what`: the middle of the sentence on it.
void declare_stiffness(Table& table, double& stiffness, const std::string& of_what) {
  table.value("stiffness", stiffness, "Young's modulus times cross-section" + of_what + " no compression",
              {.unit = "N", .range = positive});
}

void declare_skirt(Table& table, ConicalSkirt& skirt) {
  table.value("length", skirt.length, "Length along the cloth",
              {.unit = "m", .range = positive, .required = true});
  table.value("diameter", skirt.diameter, "Diameter of the lower edge",
              {.unit = "m", .range = positive, .required = true});
}

void declare_cloth(Table& table, Canopy& canopy) {
  const ChoiceKey cloth("cloth", canopy.cloth, cloth_choices);
  table.value(cloth, "MIL-C-7020 type I, 0.0373 kg/m^2, or a given area density");
  table.value("area_density", canopy.area_density, "Mass per area of the cloth",
              {.unit = "kg/m^2", .range = positive, .when = cloth.is({Fabric::custom})});
  table.value("membrane_modulus", canopy.membrane_modulus,
              "Young's modulus times thickness; the same for all canopies",
              {.unit = "N/m", .range = positive});
  table.value("poisson", canopy.poisson, "Poisson's ratio; the same for all canopies",
              {.range = between(-0.9, 0.5)});
  table.value("edge_length", canopy.edge_length,
              "Largest edge along rings and meridians; in a fluid at most a cell over 1.4, and half a cell "
              "for accuracy",
              {.unit = "m", .range = positive, .required = true});
}

void declare_place(Table& table, Canopy& canopy) {
  const ChoiceKey shape("shape", canopy.shape, shape_choices);
  table.value(shape,
              "Shape at the start: the flat cloth, a pleated cone, or the flat cloth with its axis 15, 60 or "
              "75 degrees from z");
  table.value("closure", canopy.closure, "Radius of the skirt over that of the flat cloth",
              {.range = positive.at_most(1.0), .when = shape.is({partly_closed})});
  table.value("angle", canopy.angle, "Angle of the axis from z",
              {.unit = "degrees", .range = between(-180.0, 180.0), .when = shape.is({flat, partly_closed})});
  table.value("azimuth", canopy.azimuth, "Direction towards which the axis leans, from x towards y",
              {.unit = "degrees", .range = between(-360.0, 360.0)});
  table.value("centre", canopy.centre, "Centre of the skirt at the start",
              {.unit = "m",
               .when = {[&canopy] { return !canopy.payload.shared; },
                        "without payload.shared, which places the canopy", "payload"}});
}

void declare_perturbation(Table& table, Perturbation& perturbation) {
  table.value("amplitude", perturbation.amplitude,
              "Largest displacement of a vertex along the axis of the canopy",
              {.unit = "m", .range = not_negative});
  table.value(
      "seed", perturbation.seed, "Start of the sequence of random numbers",
      {.range = between(0, 1e9),
       .when = {[&perturbation] { return perturbation.amplitude > 0.0; }, "with an amplitude", "amplitude"}});
}

void declare_line_drag(Table& table, CylinderDrag& drag) {
  table.value("diameter", drag.diameter, "Diameter of a line", {.unit = "m", .range = between(1e-6, 1.0)});
  table.value("coefficient", drag.coefficient,
              "Drag coefficient of the flow across a line, of its length times its diameter",
              {.range = between(0.0, 10.0)});
  table.value("friction", drag.friction, "Drag coefficient of the flow along a line, of the same area",
              {.range = between(0.0, 10.0)});
}

void declare_payload_drag(Table& table, PayloadDrag& drag) {
  table.value("area", drag.area, "Area", {.unit = "m^2", .range = between(1e-9, 1e6), .required = true});
  table.value("coefficient", drag.coefficient, "Drag coefficient of this area, the same from all sides",
              {.range = between(0.0, 10.0)});
}

void declare_lines(Table& table, SuspensionLines& lines, const Condition& fluid) {
  table.value("length", lines.length,
              "Length from the payload to the skirt; longer than the radius of the skirt at rest",
              {.unit = "m", .range = positive});
  declare_stiffness(table, lines.stiffness, " of each line; lines carry");
  table.value("line_density", lines.line_density,
              "Mass per length; half of it moves with the skirt, half with the payload",
              {.unit = "kg/m", .range = not_negative});
  table.value("strength", lines.strength, "Tension of a line that ends the run as a failure",
              {.unit = "N", .range = positive, .when = fluid, .default_text = "none"});
  table.optional_table("drag", lines.drag, declare_line_drag,
                       "Drag of the lines as cylinders, and its reaction on the fluid", {.when = fluid});
}

void declare_payload(Table& table, CanopyPayload& payload, const Condition& fluid,
                     const std::function<bool()>& drops) {
  const Condition own = {[&payload] { return !payload.shared; }, "without shared", "shared"};
  table.value("shared", payload.shared,
              "Number of the earlier [[canopy]] that has the payload; needs a riser",
              {.range = between(0, 1e6), .default_text = "an own payload"});
  table.value("mass", payload.mass, "Mass", {.unit = "kg", .range = positive, .when = own});
  table.value("fixed", payload.fixed, "The payload does not move", {.when = own});
  table.value("guided", payload.guided,
              "The payload moves along z alone, as on a guide wire without friction",
              {.when = {[&payload] { return !payload.shared && !payload.fixed; }, "without shared and fixed",
                        "fixed"}});
  table.value("velocity", payload.velocity,
              "Velocity of the payload with its lines and cloth at the start, in the frame of fluid.velocity",
              {.unit = "m/s",
               .when = {[&payload, drops] { return !payload.shared && !payload.fixed && !drops(); },
                        "without shared, fixed and [drop], which sets it", "fixed"}});
  table.optional_table("drag", payload.drag, declare_payload_drag, "Drag of the payload, without a wake",
                       {.when = fluid && own});
  table.value("release", payload.release, "Time at which the riser, or without one the lines, are cut",
              {.unit = "s", .range = positive, .default_text = "never"});
}

void declare_riser(Table& table, Riser& riser) {
  table.value("length", riser.length, "Length", {.unit = "m", .range = positive, .required = true});
  declare_stiffness(table, riser.stiffness, "; it carries");
  table.value("mass", riser.mass, "Mass, at the point where the lines meet",
              {.unit = "kg", .range = positive});
}

void declare_reefing(Table& table, ReefingLine& reefing) {
  table.value("length", reefing.length, "Length around; at least that of the skirt at the start",
              {.unit = "m", .range = positive, .required = true});
  declare_stiffness(table, reefing.stiffness, "; it carries");
  table.value("cut", reefing.cut, "Time at which it is cut",
              {.unit = "s", .range = positive, .default_text = "never"});
}

void declare_vent_lines(Table& table, VentLines& lines) {
  declare_stiffness(table, lines.stiffness, " of each line; lines carry");
  table.value("line_density", lines.line_density,
              "Mass per length; half of it moves with the edge of the vent, half with the crossing",
              {.unit = "kg/m", .range = positive});
}

void declare_reinforcement(Table& table, Reinforcement& bands) {
  const auto declare = [&](const char* name, double& stiffness, const std::string& where) {
    table.value(name, stiffness, "Young's modulus times cross-section of bands along " + where + "; 0: none",
                {.unit = "N", .range = not_negative});
  };
  declare("seams", bands.seams, "the seams between gores, as far as the mesh resolves them");
  declare("skirt", bands.skirt, "the skirt");
  declare("vent", bands.vent, "the vent");
}

}  // namespace

void declare_canopy(Table& table, Canopy& canopy, const Condition& fluid,
                    const std::function<bool()>& drops) {
  const ChoiceKey kind("kind", canopy.kind, canopy_choices);
  const Condition lines = {[&canopy] { return canopy.has_lines(); }, "unless kind = \"sheet\" or \"drum\"",
                           "kind"};
  table.value(kind,
              "A flat disk of cloth with a vent, such a disk with a conical skirt that is wide or narrow at "
              "its mouth, a disk without lines and payload, or one under tension with a fixed rim",
              {.required = true});
  table.value("diameter", canopy.diameter, "Diameter of the flat cloth", {.unit = "m", .range = positive});
  table.table("skirt", canopy.skirt, declare_skirt, "Conical skirt below the flat cloth",
              {.when = kind.is({extended_skirt, guide_surface}), .required = true});
  table.value("gores", canopy.gores, "Number of gores, and of suspension lines", {.range = between(3, 1000)});
  table.value("vent", canopy.vent, "Diameter of the vent; 0: none", {.unit = "m", .range = not_negative});
  declare_cloth(table, canopy);
  declare_place(table, canopy);
  table.table("perturbation", canopy.perturbation, declare_perturbation,
              "Random displacements of the cloth at the start, for several runs of a chaotic opening");
  table.value("tension", canopy.tension, "Tension of the flat cloth",
              {.unit = "N/m", .range = positive, .when = kind.is({drum}), .required = true});
  table.value("deflection", canopy.deflection,
              "Displacement of the centre along the axis at the start, in the first axisymmetric mode",
              {.unit = "m", .when = kind.is({drum})});
  table.table("lines", [&](Table& keys) { declare_lines(keys, canopy.lines, fluid); },
              "Suspension lines to the skirt, one per gore", {.when = lines});
  table.table("payload", [&, drops](Table& keys) { declare_payload(keys, canopy.payload, fluid, drops); },
              "Point mass where the lines meet, or at the end of the riser", {.when = lines});
  table.optional_table("riser", canopy.riser, declare_riser,
                       "Strap from the point where the lines meet to the payload", {.when = lines});
  table.optional_table("reefing", canopy.reefing, declare_reefing,
                       "Closed line through the skirt, between the suspension lines", {.when = lines});
  table.optional_table("vent_lines", canopy.vent_lines, declare_vent_lines,
                       "Lines across the vent from seam to seam, tied where they cross", {.when = lines});
  table.table("reinforcement", canopy.reinforcement, declare_reinforcement, "Bands sewn on the cloth");
  table.table("porosity", canopy.porosity, declare_porosity, "Flow through the cloth", {.when = fluid});
}

}  // namespace drogue::parachute_app
