#include "miniapps/parachute/bodies/body_keys.hpp"

#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Choices;
using scene::Table;

const Choices<BodyKind> body_choices = {{"plate", BodyKind::plate}};
const Choices<PorosityLaw> law_choices = {{"none", PorosityLaw::none},
                                          {"forchheimer", PorosityLaw::forchheimer}};

}  // namespace

void declare_porosity(Table& table, Porosity& porosity) {
  const auto is_porous = [&porosity] { return porosity.law == PorosityLaw::forchheimer; };
  table.value(
      "law", scene::choice_codec(porosity.law, law_choices),
      "No flow through the sheet, or the pressure difference alpha w + beta |w| w at the normal velocity w");
  table.value("alpha", scene::real_codec(porosity.alpha), "Linear coefficient")
      .unit("Pa s/m")
      .at_least(0.0)
      .when(is_porous, "with law = \"forchheimer\"", "law");
  table.value("beta", scene::real_codec(porosity.beta), "Quadratic coefficient")
      .unit("Pa s^2/m^2")
      .at_least(0.0)
      .when(is_porous, "with law = \"forchheimer\"", "law");
}

void declare_body(Table& table, Body& body) {
  table.value("kind", scene::choice_codec(body.kind, body_choices), "A rectangle without thickness")
      .required();
  table.value("normal", scene::choice_codec(body.normal, axis_choices), "Axis normal to the plate")
      .required();
  table.value("centre", vector_codec(body.centre), "Centre").unit("m").required();
  table
      .value("lengths", pair_codec(body.lengths),
             "Extents along the two other axes, in the order x, y, z; the whole width of a periodic axis is "
             "closed")
      .unit("m")
      .above(0.0)
      .required();
  table
      .value("edge_length", scene::real_codec(body.edge_length),
             "Largest edge of the triangles along the axes; at most a cell over 1.4, and half a cell for "
             "accuracy")
      .unit("m")
      .above(0.0)
      .required();
  table.table(
      "porosity", [&](Table& porosity) { declare_porosity(porosity, body.porosity); },
      "Flow through the plate");
}

void declare_coupling(Table& table, coupling::SheetParameters& coupling) {
  table
      .value("filter", scene::real_codec(coupling.filter),
             "Weight of the present step in the running mean of the acceleration of the fluid at bodies")
      .range(0.0, 1.0);
}

}  // namespace drogue::parachute_app
