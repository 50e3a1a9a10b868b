#include <cmath>

#include "kernels/fabric/contact/features.hpp"
#include "miniapps/springs/scene/scene_check.hpp"
#include "miniapps/springs/simulation/contact_state.hpp"
#include "miniapps/springs/simulation/problem.hpp"

namespace drogue::springs_app {

void check_contact(const scene::Place& root, const SpringsScene& scene) {
  const SpringsContact& contact = scene.contact;
  if (!contact.is_enabled()) return;
  for (std::size_t k = 0; k < contact.objects.size(); ++k) {
    const ContactObject& object = contact.objects[k];
    const scene::Place at = root.at("contact.objects", k);
    at.refuse_if(std::hypot(object.normal[0], object.normal[1], object.normal[2]) == 0.0, "normal",
                 " = [0, 0, 0] points nowhere");
    check_program(at, "expression", object.expression);
  }
  root.refuse_if(contact.self && !scene.has_triangles(), "contact.self",
                 " needs triangles, and the mesh has none");
  const double height = contact.self ? fabric::shortest_altitude(scene.mesh) : contact.thickness + 1.0;
  root.refuse_if(!(contact.thickness < height), "contact.thickness", " = ", contact.thickness,
                 " must be less than the least height of a triangle, ", height, " m, with contact.self");
  const ContactState start = contact_state(scene, make_problem(scene).x);
  root.refuse_if(!start.meeting.empty(), "contact", ": ", start.meeting, " where the run starts");
}

}  // namespace drogue::springs_app
