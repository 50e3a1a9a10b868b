#include <cmath>
#include <stdexcept>

#include "common/scene/node.hpp"
#include "common/scene/read.hpp"
#include "kernels/fabric/contact/features.hpp"
#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/scene/scene_check.hpp"
#include "miniapps/springs/simulation/contact_state.hpp"
#include "miniapps/springs/simulation/problem.hpp"

namespace drogue::springs_app {

using scene::contradict;
using scene::real_text;
using scene::Table;

void check_contact(const Table& root, const SpringsScene& scene) {
  const SpringsContact& contact = scene.contact;
  if (!contact.is_enabled()) return;
  for (std::size_t k = 0; k < contact.objects.size(); ++k) {
    const ContactObject& object = contact.objects[k];
    const std::string path = "contact.objects[" + std::to_string(k) + "]";
    if (std::hypot(object.normal[0], object.normal[1], object.normal[2]) == 0.0)
      contradict(root, path + ".normal", path + ".normal = [0, 0, 0] points nowhere");
    try {
      if (!object.expression.empty()) device_program(object.expression);
    } catch (const std::invalid_argument& refused) {
      contradict(root, path + ".expression", path + ".expression: " + refused.what());
    }
  }
  if (contact.self && !scene.has_triangles())
    contradict(root, "contact.self", "contact.self needs triangles, and the mesh has none");
  if (const double height = contact.self ? fabric::shortest_altitude(scene.mesh) : contact.thickness + 1.0;
      !(contact.thickness < height))
    contradict(root, "contact.thickness",
               "contact.thickness = " + real_text(contact.thickness) +
                   " must be less than the least height of a triangle, " + real_text(height) +
                   " m, with contact.self");
  const ContactState start = contact_state(scene, make_problem(scene).x);
  if (!start.meeting.empty())
    contradict(root, "contact", "contact: " + start.meeting + " where the run starts");
}

}  // namespace drogue::springs_app
