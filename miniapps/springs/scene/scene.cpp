#include "miniapps/springs/scene/scene.hpp"

#include "miniapps/framework/mini_app.hpp"
#include "miniapps/framework/obj_file.hpp"
#include "miniapps/framework/typed_scene.hpp"
#include "miniapps/springs/scene/scene_check.hpp"
#include "miniapps/springs/scene/scene_keys.hpp"
#include "miniapps/springs/vectors.hpp"

namespace drogue::springs_app {

bool SpringsScene::has_triangles() const {
  return mesh.rest.empty() ? !source.string : !mesh.triangles.empty();
}

bool SpringsScene::has_lines() const {
  return mesh.rest.empty() ? source.string || !source.file.empty() : lines > 0;
}

SpringsScene read_springs_scene(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  return framework::read_scene<SpringsScene>(file, sets, declare_springs_scene, complete_and_check);
}

std::string print_springs_scene(const SpringsScene& scene) {
  return framework::print_scene(scene, declare_springs_scene);
}

framework::SceneIdentity scene_identity(SpringsScene scene) {
  scene.description.clear();
  scene.output = {};
  scene.output.restart_every = 0;  // its former default, as in older restart files
  scene.verify = {};
  scene.driver = fabric::Driver::automatic;
  scene.time.end_time = 0.0;
  scene.time.dt.reset();
  scene.time.safety = 0.8;  // as above
  // The content of a mesh file counts, not its path.
  std::string contents;
  if (!scene.source.file.empty()) {
    contents = framework::contents_of(scene.mesh);
    scene.source.file = "mesh.obj";
    scene.source.scale = 1.0;
  }
  return {print_springs_scene(scene), contents};
}

std::filesystem::path scene_folder() {
  return framework::find_scene_folder("springs", DROGUE_SPRINGS_SCENES);
}

std::string document_springs_scene() {
  return framework::document_scene(
      declare_springs_scene, "Springs", "SpringsSceneDocument",
      R"(Expressions use the syntax of muParser; x, y, z are coordinates at rest, t is the time. Those of t, of follower pressure
and of contact.objects are evaluated in every step: each has at most 96 operations, names and numbers, of them at most
32 numbers, and waits with at most 16 operands. How a scene is verified: [springs](springs-output.md).
)");
}

}  // namespace drogue::springs_app
