#include "miniapps/parachute/canopy/canopy_keys.hpp"

#include "miniapps/parachute/bodies/body_keys.hpp"
#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Choices;
using scene::Table;

const Choices<CanopyKind> canopy_choices = {{"flat-circular", CanopyKind::flat_circular},
                                            {"extended-skirt", CanopyKind::extended_skirt},
                                            {"guide-surface", CanopyKind::guide_surface},
                                            {"sheet", CanopyKind::sheet},
                                            {"drum", CanopyKind::drum}};
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
             "Largest edge along rings and meridians; in a fluid at most a cell over 1.4, and half a cell "
             "for accuracy")
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
  table.value("angle", scene::real_codec(canopy.angle), "Angle of the axis from z")
      .unit("degrees")
      .range(-180.0, 180.0)
      .when(
          [&canopy] {
            return canopy.shape == CanopyShape::flat || canopy.shape == CanopyShape::partly_closed;
          },
          "with shape = \"flat\" or \"partly-closed\"", "shape");
  table
      .value("azimuth", scene::real_codec(canopy.azimuth),
             "Direction towards which the axis leans, from x towards y")
      .unit("degrees")
      .range(-360.0, 360.0);
  table.value("centre", vector_codec(canopy.centre), "Centre of the skirt at the start")
      .unit("m")
      .when([&canopy] { return !canopy.payload.shared; }, "without payload.shared, which places the canopy",
            "payload");
}

void declare_perturbation(Table& table, Perturbation& perturbation) {
  table
      .value("amplitude", scene::real_codec(perturbation.amplitude),
             "Largest displacement of a vertex along the axis of the canopy")
      .unit("m")
      .at_least(0.0);
  table.value("seed", scene::integer_codec(perturbation.seed), "Start of the sequence of random numbers")
      .range(0, 1e9)
      .when([&perturbation] { return perturbation.amplitude > 0.0; }, "with an amplitude", "amplitude");
}

/// Stiffness of a spring without compression. `of_what`: the middle of the sentence on it.
void declare_stiffness(Table& table, double& stiffness, const std::string& of_what) {
  table
      .value("stiffness", scene::real_codec(stiffness),
             "Young's modulus times cross-section" + of_what + " no compression")
      .unit("N")
      .above(0.0);
}

void declare_lines(Table& table, SuspensionLines& lines, const std::function<bool()>& with_fluid) {
  table
      .value("length", scene::real_codec(lines.length),
             "Length from the payload to the skirt; longer than the radius of the skirt at rest")
      .unit("m")
      .above(0.0);
  declare_stiffness(table, lines.stiffness, " of each line; lines carry");
  table
      .value("line_density", scene::real_codec(lines.line_density),
             "Mass per length; half of it moves with the skirt, half with the payload")
      .unit("kg/m")
      .at_least(0.0);
  table
      .value("strength", scene::real_codec(lines.strength),
             "Tension of a line that ends the run as a failure")
      .unit("N")
      .above(0.0)
      .default_text("none")
      .when(with_fluid, fluid_condition, "");
}

void declare_payload(Table& table, CanopyPayload& payload) {
  const auto is_own = [&payload] { return !payload.shared; };
  table
      .value("shared", optional_integer_codec(payload.shared),
             "Number of the earlier [[canopy]] that has the payload; needs a riser")
      .range(0, 1e6)
      .default_text("an own payload");
  table.value("mass", scene::real_codec(payload.mass), "Mass")
      .unit("kg")
      .above(0.0)
      .when(is_own, "without shared", "shared");
  table.value("fixed", scene::boolean_codec(payload.fixed), "The payload does not move")
      .when(is_own, "without shared", "shared");
  table
      .value("guided", scene::boolean_codec(payload.guided),
             "The payload moves along z alone, as on a guide wire without friction")
      .when([&payload] { return !payload.shared && !payload.fixed; }, "without shared and fixed", "fixed");
  table
      .value("release", scene::real_codec(payload.release),
             "Time at which the riser, or without one the lines, are cut")
      .unit("s")
      .above(0.0)
      .default_text("never");
}

void declare_riser(Table& table, Riser& riser) {
  table.value("length", scene::real_codec(riser.length), "Length").unit("m").above(0.0).required();
  declare_stiffness(table, riser.stiffness, "; it carries");
  table.value("mass", scene::real_codec(riser.mass), "Mass, at the point where the lines meet")
      .unit("kg")
      .above(0.0);
}

void declare_reefing(Table& table, ReefingLine& reefing) {
  table
      .value("length", scene::real_codec(reefing.length),
             "Length around; at least that of the skirt at the start")
      .unit("m")
      .above(0.0)
      .required();
  declare_stiffness(table, reefing.stiffness, "; it carries");
  table.value("cut", scene::real_codec(reefing.cut), "Time at which it is cut")
      .unit("s")
      .above(0.0)
      .default_text("never");
}

void declare_vent_lines(Table& table, VentLines& lines) {
  declare_stiffness(table, lines.stiffness, " of each line; lines carry");
  table
      .value("line_density", scene::real_codec(lines.line_density),
             "Mass per length; half of it moves with the edge of the vent, half with the crossing")
      .unit("kg/m")
      .above(0.0);
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

void declare_canopy(Table& table, Canopy& canopy, const std::function<bool()>& with_fluid) {
  const auto has_lines = [&canopy] { return canopy.has_lines(); };
  const auto is_drum = [&canopy] { return canopy.kind == CanopyKind::drum; };
  const std::string no_sheet = "unless kind = \"sheet\" or \"drum\"", of_drum = "with kind = \"drum\"";
  table
      .value("kind", scene::choice_codec(canopy.kind, canopy_choices),
             "A flat disk of cloth with a vent, such a disk with a conical skirt that is wide or narrow at "
             "its mouth, a disk without lines and payload, or one under tension with a fixed rim")
      .required();
  table.value("diameter", scene::real_codec(canopy.diameter), "Diameter of the flat cloth")
      .unit("m")
      .above(0.0);
  table
      .table(
          "skirt",
          [&](Table& skirt) {
            skirt.value("length", scene::real_codec(canopy.skirt.length), "Length along the cloth")
                .unit("m")
                .above(0.0)
                .required();
            skirt.value("diameter", scene::real_codec(canopy.skirt.diameter), "Diameter of the lower edge")
                .unit("m")
                .above(0.0)
                .required();
          },
          "Conical skirt below the flat cloth")
      .when([&canopy] { return canopy.has_skirt(); }, "with kind = \"extended-skirt\" or \"guide-surface\"",
            "kind")
      .required();
  table.value("gores", scene::integer_codec(canopy.gores), "Number of gores, and of suspension lines")
      .range(3, 1000);
  table.value("vent", scene::real_codec(canopy.vent), "Diameter of the vent; 0: none")
      .unit("m")
      .at_least(0.0);
  declare_cloth(table, canopy);
  declare_place(table, canopy);
  table.table(
      "perturbation", [&](Table& perturbation) { declare_perturbation(perturbation, canopy.perturbation); },
      "Random displacements of the cloth at the start, for several runs of a chaotic opening");
  table.value("tension", scene::real_codec(canopy.tension), "Tension of the flat cloth")
      .unit("N/m")
      .above(0.0)
      .when(is_drum, of_drum, "kind")
      .required();
  table
      .value("deflection", scene::real_codec(canopy.deflection),
             "Displacement of the centre along the axis at the start, in the first axisymmetric mode")
      .unit("m")
      .when(is_drum, of_drum, "kind");
  table
      .table(
          "lines", [&](Table& lines) { declare_lines(lines, canopy.lines, with_fluid); },
          "Suspension lines to the skirt, one per gore, without drag")
      .when(has_lines, no_sheet, "kind");
  table
      .table(
          "payload", [&](Table& payload) { declare_payload(payload, canopy.payload); },
          "Point mass where the lines meet, or at the end of the riser")
      .when(has_lines, no_sheet, "kind");
  table
      .optional_table("riser", canopy.riser, declare_riser,
                      "Strap from the point where the lines meet to the payload")
      .when(has_lines, no_sheet, "kind");
  table
      .optional_table("reefing", canopy.reefing, declare_reefing,
                      "Closed line through the skirt, between the suspension lines")
      .when(has_lines, no_sheet, "kind");
  table
      .optional_table("vent_lines", canopy.vent_lines, declare_vent_lines,
                      "Lines across the vent from seam to seam, tied where they cross")
      .when(has_lines, no_sheet, "kind");
  table.table(
      "reinforcement", [&](Table& bands) { declare_reinforcement(bands, canopy.reinforcement); },
      "Bands sewn on the cloth");
  table
      .table(
          "porosity", [&](Table& porosity) { declare_porosity(porosity, canopy.porosity); },
          "Flow through the cloth")
      .when(with_fluid, fluid_condition, "");
}

}  // namespace drogue::parachute_app
