#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/scene/document.hpp"
#include "common/scene/print.hpp"
#include "common/scene/read.hpp"
#include "miniapps/framework/simulation.hpp"

namespace drogue::framework {

/// Declares the keys of a scene, whose values it reads from and writes to `content`.
template <class Content>
using DeclareScene = void (*)(scene::Table& root, Content& content);

/// Reads a scene file with its `--set` assignments. `complete(root, content)` fills in and checks values that
/// depend on several keys. Throws `Failure` (invalid_scene, usage).
template <class Content, class Complete>
Content read_scene(const std::filesystem::path& file, const std::vector<std::string>& assignments,
                   DeclareScene<Content> declare, const Complete& complete) {
  Content content;
  content.file = file;
  content.name = file.stem().string();
  scene::Table root;
  declare(root, content);
  scene::read_file(root, file, assignments);
  complete(root, content);
  return content;
}

/// The scene as TOML, with every key.
template <class Content>
std::string print_scene(Content content, DeclareScene<Content> declare) {
  scene::Table root;
  declare(root, content);
  return scene::print(root);
}

/// Markdown page of all keys of the scenes of an app. `title`: `Gas`; `test`: name of the test that writes
/// the page; `notes`: sentences after those that hold for all apps, each line with its end.
template <class Content>
std::string document_scene(DeclareScene<Content> declare, const std::string& title, const std::string& test,
                           std::string_view notes = "") {
  Content defaults;
  scene::Table root;
  declare(root, defaults);
  return "# " + title + R"( scenes: all keys

Written from the declarations that also read, check and print a scene; do not edit. After a change of them:
`DROGUE_UPDATE_DOCS=1 ctest --test-dir build/host -R )" +
         test + R"(`.

A scene is a TOML file. Unknown keys are refused. Numbers are in SI units; an integer is accepted for a real.
)" + std::string(notes) +
         "\n" + scene::document(root);
}

/// Scene with the values `Content`, which `Run` simulates. `scene_identity(Content)` is found by its
/// argument.
template <class Content, class Run>
class TypedScene : public Scene {
 public:
  TypedScene(Content content, DeclareScene<Content> declare)
      : _content(std::move(content)), _declare(declare) {}

  [[nodiscard]] std::string print() const override { return print_scene(_content, _declare); }
  [[nodiscard]] SceneIdentity identity() const override { return scene_identity(_content); }
  [[nodiscard]] std::vector<std::string> notices() const override {
    if constexpr (requires { _content.notices; }) return _content.notices;
    return {};
  }
  [[nodiscard]] std::vector<HistoryCheck> history_checks() const override {
    if constexpr (requires { _content.verify.history; }) return _content.verify.history;
    return {};
  }
  [[nodiscard]] std::unique_ptr<Simulation> create(const SimulationSettings& settings) const override {
    return std::make_unique<Run>(_content, settings);
  }

 protected:
  [[nodiscard]] const Content& content() const { return _content; }

 private:
  Content _content;
  DeclareScene<Content> _declare;
};

}  // namespace drogue::framework
