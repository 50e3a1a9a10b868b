#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {
namespace {

using scene::between, scene::ChoiceKey, scene::Choices, scene::not_negative, scene::positive, scene::Table;

using enum BodyKind;
using enum PorosityLaw;

const Choices<BodyKind> body_choices = {{"plate", plate},       {"disk", disk}, {"sphere", sphere},
                                        {"cylinder", cylinder}, {"cup", cup},   {"file", file}};
const Choices<PorosityLaw> law_choices = {
    {"none", none}, {"forchheimer", forchheimer}, {"ergun", ergun}, {"kim-peskin", kim_peskin}};
const Choices<bool> opening_choices = {{"low", false}, {"high", true}};
const Choices<bool> end_choices = {{"open", false}, {"closed", true}};

void declare_mount(Table& table, Mount& mount) {
  table.value("mass", mount.mass, "Mass of the plate", {.unit = "kg", .range = positive, .required = true});
  table.value("stiffness", mount.stiffness, "Stiffness of the spring",
              {.unit = "N/m", .range = positive, .required = true});
  table.value("offset", mount.offset,
              "Displacement of the plate from centre, where the spring is slack, at the start",
              {.unit = "m"});
}

void declare_motion(Table& table, std::array<std::string, 3>& motion) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    table.value(axis_names[axis], scene::real_or_expression_codec(motion[axis], {"t"}),
                std::string("Displacement from centre along ") + axis_names[axis], {.unit = "m"});
}

}  // namespace

void declare_porosity(Table& table, Porosity& porosity) {
  const ChoiceKey law("law", porosity.law, law_choices);
  table.value(
      law,
      "No flow through the sheet, or the pressure difference alpha w + beta |w| w at the normal "
      "velocity w: alpha and beta as given, of a packed bed (Ergun 1952), or of pores (Kim and Peskin "
      "2006)");
  table.value("alpha", porosity.alpha, "Linear coefficient",
              {.unit = "Pa s/m", .range = not_negative, .when = law.is({forchheimer})});
  table.value("beta", porosity.beta, "Quadratic coefficient",
              {.unit = "Pa s^2/m^2", .range = not_negative, .when = law.is({forchheimer})});
  table.value("void_fraction", porosity.void_fraction, "Volume of voids over that of the sheet",
              {.range = positive.below(1.0), .when = law.is({ergun}), .required = true});
  table.value("thickness", porosity.thickness, "Thickness of the sheet",
              {.unit = "m", .range = positive, .when = law.is({ergun}), .required = true});
  table.value("grain", porosity.grain, "Diameter of its grains or threads",
              {.unit = "m", .range = positive, .when = law.is({ergun}), .required = true});
  table.value("pores", porosity.pores, "Number of pores per area",
              {.unit = "1/m^2", .range = positive, .when = law.is({kim_peskin}), .required = true});
  table.value("conductance", porosity.conductance, "Flow rate through a pore over the pressure difference",
              {.unit = "m^3/(Pa s)", .range = positive, .when = law.is({kim_peskin}), .required = true});
}

void declare_body(Table& table, Body& body) {
  const ChoiceKey kind("kind", body.kind, body_choices);
  table.value(kind,
              "A rectangle, a disk, a sphere, a cylinder, half of a sphere that is open on one side, or the "
              "triangles of a file; without thickness",
              {.required = true});
  table.value("normal", body.axis, axis_choices, "Axis normal to the sheet",
              {.when = kind.is({plate, disk}), .required = true});
  table.value("axis", body.axis, axis_choices,
              "Axis of symmetry; in two dimensions, that of a cylinder has the single cell",
              {.when = kind.is({cylinder, cup}), .required = true});
  table.value("centre", body.centre,
              "Centre; of a cup, that of the whole sphere; of a file, the place of its origin",
              {.unit = "m", .required = true});
  table.value("lengths", body.lengths,
              "Extents along the two other axes, in the order x, y, z; the whole width of a periodic axis is "
              "closed",
              {.unit = "m", .range = positive, .when = kind.is({plate}), .required = true});
  table.value("hole", body.hole, "Radius of a round hole in the middle of a square plate; 0: none",
              {.unit = "m", .range = not_negative, .when = kind.is({plate})});
  table.value(
      "radius", body.radius, "Radius",
      {.unit = "m", .range = positive, .when = kind.is({disk, sphere, cylinder, cup}), .required = true});
  table.value("length", body.length, "Extent along the axis",
              {.unit = "m", .range = positive, .when = kind.is({cylinder}), .required = true});
  table.value("ends", body.has_ends, end_choices, "Ends of the cylinder: a tube, or closed by disks",
              {.when = kind.is({cylinder})});
  table.value("opening", body.opens_to_high, opening_choices, "Side along the axis to which the cup is open",
              {.when = kind.is({cup}), .required = true});
  table.value("file", scene::text_codec(body.file),
              "A Wavefront OBJ file (v, f), relative to the scene; larger faces are divided into triangles",
              {.when = kind.is({file}), .required = true});
  table.value("scale", body.scale, "Metres per unit of length of the file",
              {.range = positive, .when = kind.is({file})});
  table.value("edge_length", body.edge_length,
              "Largest edge of the triangles, of a plate or tube along its sides; at most a cell over 1.4, "
              "and half a cell for accuracy",
              {.unit = "m",
               .range = positive,
               .when = kind.is({plate, disk, sphere, cylinder, cup}),
               .required = true});
  table.value("retraction", body.retraction,
              "Cells by which the triangles lie inside of the body along each axis; 0.3 for spheres and 0.2 "
              "for cylinders make up for the width of the delta function, where the fluid inside is at rest; "
              "not with contact or method = \"sharp\"",
              {.range = between(0.0, 1.0), .when = kind.is({sphere, cylinder, cup})});
  table.table("motion", body.motion, declare_motion,
              "Prescribed motion; the fluid takes part in it from time 0 on");
  table.value("slip", body.slip, "The fluid slips freely along the sheet, or has its velocity",
              {.default_text = "`true` for plates and disks, else `false`"});
  table.optional_table("mount", body.mount, declare_mount,
                       "Spring along the normal of a plate that closes a periodic channel",
                       {.when = {[&body] { return body.kind == plate && !body.moves(); },
                                 "with kind = \"plate\" and without motion", "kind"}});
  table.table("porosity", body.porosity, declare_porosity, "Flow through the sheet");
}

}  // namespace drogue::parachute_app
