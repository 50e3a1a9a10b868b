#include "common/scene/codec.hpp"
#include "miniapps/springs/scene/scene_keys.hpp"

namespace drogue::springs_app {
namespace {

using fabric::BodyKind;
using scene::between, scene::not_negative, scene::positive, scene::Table;

const scene::Choices<BodyKind> body_choices = {{"disk", BodyKind::disk},
                                               {"sphere", BodyKind::sphere},
                                               {"plane", BodyKind::plane},
                                               {"level-set", BodyKind::level_set}};

void declare_object(Table& table, ContactObject& object) {
  const auto is = [&object](BodyKind kind) { return object.kind == kind; };
  table.value("kind", object.kind, body_choices,
              "A plate without thickness, a ball, the half space behind a plane, or the region where an "
              "expression is negative",
              {.required = true, .decisive = true});
  table.value(
      "centre", vector_codec(object.centre), "Centre; for a plane one of its points",
      {.unit = "m",
       .when = {[=] { return !is(BodyKind::level_set); }, "with kind disk, sphere or plane", "kind"}});
  table.value("normal", vector_codec(object.normal),
              "Normal of a disk; outward normal of a plane; of any length",
              {.when = {[=] { return is(BodyKind::disk) || is(BodyKind::plane); }, "with kind disk or plane",
                        "kind"}});
  table.value("radius", object.radius, "Radius",
              {.unit = "m",
               .range = positive,
               .when = {[=] { return is(BodyKind::disk) || is(BodyKind::sphere); },
                        "with kind disk or sphere", "kind"},
               .required = true});
  table.value(
      "expression", scene::expression_codec(object.expression, {"x", "y", "z"}),
      "Negative inside the body; x, y, z are present positions; the gradient must not vanish near the "
      "surface",
      {.when = {[=] { return is(BodyKind::level_set); }, "with kind level-set", "kind"}, .required = true});
  table.value("friction", object.friction, "Coulomb's coefficient", {.range = not_negative});
}

}  // namespace

void declare_contact(Table& table, SpringsContact& contact) {
  table.tables("objects", contact.objects, declare_object, "Impenetrable bodies at rest");
  scene::Codec self = scene::codec_of(contact.self);
  // Without bodies and self-contact the table is absent.
  self.print = [print = self.print, &contact] { return contact.is_enabled() ? print() : std::nullopt; };
  table.value("self", self, "Contact of cloth and strings with themselves", {.default_text = "`false`"});
  table.value(
      "thickness", contact.thickness,
      "Distance that contact keeps, between layers and from bodies; with self less than the least height "
      "of a triangle",
      {.unit = "m",
       .range = positive,
       .when = {[&contact] { return contact.is_enabled(); }, "with objects or self", "self"}});
  table.value("friction", contact.friction, "Coulomb's coefficient between layers",
              {.range = not_negative, .when = {[&contact] { return contact.self; }, "with self", "self"}});
}

}  // namespace drogue::springs_app
