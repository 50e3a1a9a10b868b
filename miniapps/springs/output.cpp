#include "miniapps/springs/output.hpp"

#include <algorithm>
#include <chrono>

#include "kernels/mesh/edges.hpp"
#include "miniapps/springs/history.hpp"
#include "miniapps/springs/stress_fields.hpp"
#include "miniapps/springs/vectors.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Vector;

/// Adds the time until it is destroyed to a sum of seconds.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : _sum(sum) {}
  ~Stopwatch() { _sum += std::chrono::duration<double>(Clock::now() - _begin).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& _sum;
  Clock::time_point _begin = Clock::now();
};

run::DatasetSpec field_spec(const std::string& name, const fabric::Mesh& mesh) {
  const std::uint64_t vertices = mesh.rest.size();
  if (name == "position") return {name, {vertices, 3}, "m", "vertex", "positions of the vertices"};
  if (name == "velocity") return {name, {vertices, 3}, "m/s", "vertex", "velocities of the vertices"};
  return stress_spec(name, mesh);
}

std::vector<run::DatasetSpec> field_specs(const SpringsScene& scene) {
  std::vector<run::DatasetSpec> specs;
  for (const std::string& name : scene.output.fields) specs.push_back(field_spec(name, scene.mesh));
  return specs;
}

/// Numbers of parts as a dataset, row by row.
template <std::size_t n>
run::IntegerSource source_of(const std::vector<std::array<int, n>>& parts) {
  return [&parts](std::uint64_t first, std::span<std::int64_t> values) {
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = parts[(first + k) / n][(first + k) % n];
  };
}

}  // namespace

RunOutput::RunOutput(const SpringsScene& scene, const run::RunDirectory& directory,
                     std::optional<double> resume_time, const std::filesystem::path& restart)
    : _scene(scene), _restart_file(directory.file("restart.h5")), _fingerprint(scene_fingerprint(scene)) {
  if (scene.output.history_every > 0) {
    const std::filesystem::path file = directory.file("history.csv");
    const std::vector<run::Column> columns = history_columns(scene);
    if (resume_time) take_history(restart, columns, file);
    _history.emplace(file, columns, resume_time);
    if (_history->continues()) _last_row_time = *resume_time;
  }
  if (scene.output.fields.empty()) return;
  _fields.emplace(directory.path(), scene.name, field_specs(scene), resume_time);
  add_mesh();
}

void RunOutput::add_mesh() {
  const fabric::Mesh& mesh = _scene.mesh;
  const auto edges = edges_of(mesh);
  _fields->add_mesh({"triangles", {mesh.triangles.size(), 3}, "1", "face", "vertices of every triangle"},
                    source_of(mesh.triangles));
  _fields->add_mesh({"edges", {edges.size(), 2}, "1", "edge", "vertices of every edge and line"},
                    source_of(edges));
  // Edges do not tell which of them are strings.
  _fields->add_mesh({"strings",
                     {mesh.lines.size(), 2},
                     "1",
                     "edge",
                     "vertices of every piece of a string, those that reinforce edges of cloth alone last"},
                    source_of(mesh.lines));
  // Last: with it fields.xdmf is complete.
  _fields->add_mesh({"vertices", {mesh.rest.size(), 3}, "m", "vertex", "vertices at rest"},
                    [&mesh](std::uint64_t first, std::span<double> values) {
                      const auto from = numbers(mesh.rest).subspan(first, values.size());
                      std::ranges::copy(from, values.begin());
                    });
}

void RunOutput::write_row(const Row& row) {
  if (!_history || row.time == _last_row_time) return;
  _last_row_time = row.time;
  std::vector<double> values = {static_cast<double>(row.step), row.kinetic, row.elastic, row.potential,
                                row.kinetic + row.elastic + row.potential};
  const auto append = [&values](const Vector& v) { values.insert(values.end(), v.begin(), v.end()); };
  append(row.momentum);
  append(row.angular_momentum);
  if (_scene.contact.asked_for()) values.insert(values.end(), {row.contact_work, row.friction_work});
  if (_scene.verify.intersections) values.push_back(row.intersections);
  std::ranges::for_each(row.probes, append);
  _history->append(row.time, values);
}

void RunOutput::write_fields(Snapshot snapshot) {
  if (!_fields) return;
  const Stopwatch watch(_waited);
  _writer.submit([this, now = std::move(snapshot)] {
    _fields->begin_step(now.time, now.step);
    for (const std::string& name : _scene.output.fields)
      _fields->write(name, 0,
                     name == "position"   ? numbers(now.position)
                     : name == "velocity" ? numbers(now.velocity)
                                          : std::span<const double>(now.stress.at(name)));
    _fields->end_step();
  });
}

void RunOutput::write_restart(const RestartState& state) {
  const Stopwatch watch(_waited);
  _writer.finish();
  if (_history) _history->flush();  // a restart must find every row before it
  springs_app::write_restart(_restart_file, _fingerprint, state);
}

void RunOutput::finish() {
  const Stopwatch watch(_waited);
  _writer.finish();
  if (_history) _history->finish();
}

}  // namespace drogue::springs_app
