#include "common/scene/codec.hpp"
#include "miniapps/springs/scene/scene_keys.hpp"

namespace drogue::springs_app {
namespace {

using fabric::BodyKind;
using scene::Table;

const scene::Choices<BodyKind> body_choices = {{"disk", BodyKind::disk},
                                               {"sphere", BodyKind::sphere},
                                               {"plane", BodyKind::plane},
                                               {"level-set", BodyKind::level_set}};

void declare_object(Table& table, ContactObject& object) {
  const auto is = [&object](BodyKind kind) { return object.kind == kind; };
  table
      .value("kind", scene::choice_codec(object.kind, body_choices),
             "A plate without thickness, a ball, the half space behind a plane, or the region where an "
             "expression is negative")
      .required()
      .decisive();
  table.value("centre", vector_codec(object.centre), "Centre; for a plane one of its points")
      .unit("m")
      .when([=] { return !is(BodyKind::level_set); }, "with kind disk, sphere or plane", "kind");
  table
      .value("normal", vector_codec(object.normal),
             "Normal of a disk; outward normal of a plane; of any length")
      .when([=] { return is(BodyKind::disk) || is(BodyKind::plane); }, "with kind disk or plane", "kind");
  table.value("radius", scene::real_codec(object.radius), "Radius")
      .unit("m")
      .above(0.0)
      .required()
      .when([=] { return is(BodyKind::disk) || is(BodyKind::sphere); }, "with kind disk or sphere", "kind");
  table
      .value("expression", scene::expression_codec(object.expression, {"x", "y", "z"}),
             "Negative inside the body; x, y, z are present positions; the gradient must not vanish near the "
             "surface")
      .required()
      .when([=] { return is(BodyKind::level_set); }, "with kind level-set", "kind");
  table.value("friction", scene::real_codec(object.friction), "Coulomb's coefficient").at_least(0.0);
}

}  // namespace

void declare_contact(Table& table, SpringsContact& contact) {
  table.tables("objects", contact.objects, declare_object, "Impenetrable bodies at rest");
  scene::Codec self = scene::boolean_codec(contact.self);
  // Without bodies and self-contact the table is absent.
  self.print = [print = self.print, &contact] { return contact.is_enabled() ? print() : std::nullopt; };
  table.value("self", self, "Contact of cloth and strings with themselves").default_text("`false`");
  table
      .value(
          "thickness", scene::real_codec(contact.thickness),
          "Distance that contact keeps, between layers and from bodies; with self less than the least height "
          "of a triangle")
      .unit("m")
      .above(0.0)
      .when([&contact] { return contact.is_enabled(); }, "with objects or self", "self");
  table.value("friction", scene::real_codec(contact.friction), "Coulomb's coefficient between layers")
      .at_least(0.0)
      .when([&contact] { return contact.self; }, "with self", "self");
}

}  // namespace drogue::springs_app
