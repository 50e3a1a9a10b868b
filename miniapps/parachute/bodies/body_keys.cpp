#include "miniapps/parachute/bodies/body_keys.hpp"

#include <algorithm>

#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Choices;
using scene::Table;

const Choices<BodyKind> body_choices = {{"plate", BodyKind::plate},   {"disk", BodyKind::disk},
                                        {"sphere", BodyKind::sphere}, {"cylinder", BodyKind::cylinder},
                                        {"cup", BodyKind::cup},       {"file", BodyKind::file}};
const Choices<PorosityLaw> law_choices = {{"none", PorosityLaw::none},
                                          {"forchheimer", PorosityLaw::forchheimer},
                                          {"ergun", PorosityLaw::ergun},
                                          {"kim-peskin", PorosityLaw::kim_peskin}};
const Choices<bool> opening_choices = {{"low", false}, {"high", true}};
const Choices<coupling::CouplingMethod> method_choices = {{"spread", coupling::CouplingMethod::spread},
                                                          {"explicit", coupling::CouplingMethod::explicit_},
                                                          {"sharp", coupling::CouplingMethod::sharp}};
const Choices<bool> end_choices = {{"open", false}, {"closed", true}};

}  // namespace

void declare_porosity(Table& table, Porosity& porosity) {
  table.value(
      "law", scene::choice_codec(porosity.law, law_choices),
      "No flow through the sheet, or the pressure difference alpha w + beta |w| w at the normal "
      "velocity w: alpha and beta as given, of a packed bed (Ergun 1952), or of pores (Kim and Peskin "
      "2006)");
  const auto with = [&table, &porosity](const char* key, double& value, const std::string& help,
                                        PorosityLaw law, const std::string& name) -> scene::Key& {
    return table.value(key, scene::real_codec(value), help)
        .when([&porosity, law] { return porosity.law == law; }, "with law = \"" + name + "\"", "law");
  };
  using enum PorosityLaw;
  with("alpha", porosity.alpha, "Linear coefficient", forchheimer, "forchheimer")
      .unit("Pa s/m")
      .at_least(0.0);
  with("beta", porosity.beta, "Quadratic coefficient", forchheimer, "forchheimer")
      .unit("Pa s^2/m^2")
      .at_least(0.0);
  const std::string bed = "ergun", pores = "kim-peskin";
  with("void_fraction", porosity.void_fraction, "Volume of voids over that of the sheet", ergun, bed)
      .above(0.0)
      .below(1.0)
      .required();
  with("thickness", porosity.thickness, "Thickness of the sheet", ergun, bed).unit("m").above(0.0).required();
  with("grain", porosity.grain, "Diameter of its grains or threads", ergun, bed)
      .unit("m")
      .above(0.0)
      .required();
  with("pores", porosity.pores, "Number of pores per area", kim_peskin, pores)
      .unit("1/m^2")
      .above(0.0)
      .required();
  with("conductance", porosity.conductance, "Flow rate through a pore over the pressure difference",
       kim_peskin, pores)
      .unit("m^3/(Pa s)")
      .above(0.0)
      .required();
}

/// Condition of keys that some kinds of bodies have.
struct KindCondition {
  const Body& body;
  std::vector<BodyKind> kinds;

  [[nodiscard]] std::function<bool()> holds() const {
    return [&of = body, list = kinds] { return std::ranges::find(list, of.kind) != list.end(); };
  }
  [[nodiscard]] std::string text() const {
    std::string names;
    for (const auto& [name, kind] : body_choices)
      if (std::ranges::find(kinds, kind) != kinds.end())
        names += (names.empty() ? "" : " or ") + ("\"" + name + "\"");
    return "with kind = " + names;
  }
};

scene::Key& declare_for(Table& table, const std::string& name, scene::Codec codec, const std::string& help,
                        const KindCondition& of) {
  return table.value(name, std::move(codec), help).when(of.holds(), of.text(), "kind");
}

void declare_shape(Table& table, Body& body) {
  using enum BodyKind;
  declare_for(table, "normal", scene::choice_codec(body.axis, axis_choices), "Axis normal to the sheet",
              {body, {plate, disk}})
      .required();
  declare_for(table, "axis", scene::choice_codec(body.axis, axis_choices),
              "Axis of symmetry; in two dimensions, that of a cylinder has the single cell",
              {body, {cylinder, cup}})
      .required();
  table
      .value("centre", vector_codec(body.centre),
             "Centre; of a cup, that of the whole sphere; of a file, the place of its origin")
      .unit("m")
      .required();
  declare_for(table, "lengths", pair_codec(body.lengths),
              "Extents along the two other axes, in the order x, y, z; the whole width of a periodic axis is "
              "closed",
              {body, {plate}})
      .unit("m")
      .above(0.0)
      .required();
  declare_for(table, "radius", scene::real_codec(body.radius), "Radius",
              {body, {disk, sphere, cylinder, cup}})
      .unit("m")
      .above(0.0)
      .required();
  declare_for(table, "length", scene::real_codec(body.length), "Extent along the axis", {body, {cylinder}})
      .unit("m")
      .above(0.0)
      .required();
  declare_for(table, "ends", scene::choice_codec(body.has_ends, end_choices),
              "Ends of the cylinder: a tube, or closed by disks", {body, {cylinder}});
  declare_for(table, "opening", scene::choice_codec(body.opens_to_high, opening_choices),
              "Side along the axis to which the cup is open", {body, {cup}})
      .required();
  declare_for(table, "file", scene::text_codec(body.file),
              "A Wavefront OBJ file (v, f), relative to the scene; larger faces are divided into triangles",
              {body, {file}})
      .required();
  declare_for(table, "scale", scene::real_codec(body.scale), "Metres per unit of length of the file",
              {body, {file}})
      .above(0.0);
}

/// Boolean that is absent unless given.
scene::Codec optional_boolean_codec(std::optional<bool>& value) {
  return {"boolean",
          [&value](const scene::Node& node, const scene::Limits& limits) {
            bool read = false;
            std::string fault = scene::boolean_codec(read).read(node, limits);
            if (fault.empty()) value = read;
            return fault;
          },
          [&value]() -> std::optional<std::string> {
            if (!value) return std::nullopt;
            return *value ? "true" : "false";
          },
          scene::back_to_default(value)};
}

void declare_mount(Table& table, Mount& mount) {
  table.value("mass", scene::real_codec(mount.mass), "Mass of the plate").unit("kg").above(0.0).required();
  table.value("stiffness", scene::real_codec(mount.stiffness), "Stiffness of the spring")
      .unit("N/m")
      .above(0.0)
      .required();
  table
      .value("offset", scene::real_codec(mount.offset),
             "Displacement of the plate from centre, where the spring is slack, at the start")
      .unit("m");
}

void declare_body(Table& table, Body& body) {
  using enum BodyKind;
  table
      .value("kind", scene::choice_codec(body.kind, body_choices),
             "A rectangle, a disk, a sphere, a cylinder, half of a sphere that is open on one side, or the "
             "triangles of a file; without thickness")
      .required();
  declare_shape(table, body);
  declare_for(table, "edge_length", scene::real_codec(body.edge_length),
              "Largest edge of the triangles, of a plate or tube along its sides; at most a cell over 1.4, "
              "and half a cell for accuracy",
              {body, {plate, disk, sphere, cylinder, cup}})
      .unit("m")
      .above(0.0)
      .required();
  declare_for(
      table, "retraction", scene::real_codec(body.retraction),
      "Cells by which the triangles lie inside of the body along each axis; 0.3 for spheres and 0.2 for "
      "cylinders make up for the width of the delta function, where the fluid inside is at rest; not "
      "with contact or method = \"sharp\"",
      {body, {sphere, cylinder, cup}})
      .range(0.0, 1.0);
  table.table(
      "motion",
      [&](Table& motion) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          motion
              .value(axis_names[axis], scene::real_or_expression_codec(body.motion[axis], {"t"}),
                     std::string("Displacement from centre along ") + axis_names[axis])
              .unit("m");
      },
      "Prescribed motion; the fluid takes part in it from time 0 on");
  table
      .value("slip", optional_boolean_codec(body.slip),
             "The fluid slips freely along the sheet, or has its velocity")
      .default_text("`true` for plates and disks, else `false`");
  table
      .optional_table("mount", body.mount, declare_mount,
                      "Spring along the normal of a plate that closes a periodic channel")
      .when([&body] { return body.kind == plate && !body.moves(); },
            "with kind = \"plate\" and without motion", "kind");
  table.table(
      "porosity", [&](Table& porosity) { declare_porosity(porosity, body.porosity); },
      "Flow through the sheet");
}

void declare_coupling(Table& table, coupling::SheetParameters& coupling,
                      const std::function<bool()>& with_fluid) {
  table
      .value(
          "method", scene::choice_codec(coupling.method, method_choices),
          "Coupling of sheets to the fluid: by smoothed delta functions, against which canopies relax in "
          "each step of the cloth; likewise, but the cloth takes the force of the last step of the flow and "
          "imposes its velocity, as in [Shi]; or pressure jumps between the cells that a body separates")
      .when(with_fluid, fluid_condition, "");
  table
      .value("filter", scene::real_codec(coupling.filter),
             "Weight of the present step in the running mean of the acceleration of the fluid at sheets")
      .range(0.0, 1.0)
      .when(with_fluid, fluid_condition, "");
  table
      .value("defect_filter", scene::real_codec(coupling.defect_filter),
             "Weight of the present step in the running mean of what delta functions give the fluid at a "
             "vertex less what the vertex expects; 0: none, so that curved sheets leak in proportion to dt")
      .range(0.0, 0.2)
      .when([with_fluid,
             &coupling] { return with_fluid() && coupling.method == coupling::CouplingMethod::spread; },
            "with [fluid] and method = \"spread\"", "method");
  table
      .value("edge_inset", scene::real_codec(coupling.edge_inset),
             "Cells by which free edges of sheets lie farther inwards where they exchange forces with the "
             "fluid; 0.55 makes up for the width of the delta function, which else acts beyond the edges; "
             "the fluid passes between sheets that touch")
      .range(0.0, 1.0)
      .when([with_fluid,
             &coupling] { return with_fluid() && coupling.method != coupling::CouplingMethod::sharp; },
            "with [fluid] and method = \"spread\" or \"explicit\"", "method");
}

}  // namespace drogue::parachute_app
