#include <cmath>
#include <numbers>

#include "common/scene/codec.hpp"
#include "common/scene/print.hpp"
#include "common/scene/read.hpp"
#include "miniapps/framework/mini_app.hpp"

// drogue-heat: u_t = u_xx on the unit interval with periodic ends, from sin(2 pi x), by explicit Euler steps.
using namespace drogue;
constexpr double k = 2.0 * std::numbers::pi;  // wave number, 1/m

struct HeatData {
  std::string description;
  std::int64_t cells = 64;
  double end_time = 0.0;  // s
  framework::OutputRequest output;
  std::optional<double> linf;  // tolerance of the error
};

struct Heat final : framework::Simulation {
  explicit Heat(const HeatData& data) : _data(data), _x(static_cast<std::size_t>(data.cells)), _u(_x) {
    for (std::size_t i = 0; i < _x.size(); ++i)
      _x[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(_x.size());
  }
  const framework::OutputRequest& output() const override { return _data.output; }
  framework::EndTime end_time() const override { return {_data.end_time, "end_time"}; }
  void start() override {
    for (std::size_t i = 0; i < _u.size(); ++i) _u[i] = exact(i);
  }
  void restore(const run::RestartReader& reader) override {
    _now = {reader.integer("step"), reader.number("time")};
    reader.read("u", 0, _u);
  }
  void write_restart(run::RestartWriter& writer) override {
    writer.integer("step", _now.step);
    writer.number("time", _now.time);
    writer.array("u", _u.size());
    writer.write("u", 0, _u);
  }
  framework::SimulationTime now() override { return _now; }
  framework::StopReason advance(const framework::AdvanceLimits& limits, const framework::RowSink& rows,
                                const framework::Poll& poll) override {
    while (_now.time < limits.target_time) {
      if (!poll(_now)) return framework::StopReason::interrupted;
      step(limits.target_time);
      if (limits.row_every > 0 && _now.step % limits.row_every == 0) rows(row());
      if (_now.step == limits.pause_step) return framework::StopReason::pause;
    }
    return framework::StopReason::target;
  }
  std::vector<run::Column> history_columns() const override { return {{"u_0", ""}}; }
  framework::HistoryRow row() override { return {_now.time, {_u[0]}}; }
  std::vector<run::DatasetSpec> field_specs() const override { return {{"u", {_u.size()}, "K", "cell", ""}}; }
  void write_mesh(run::FieldSink& fields) const override {
    fields.add_mesh({"x", {_u.size()}, "m", "cell", "cell centres"}, _x);
  }
  framework::FieldsTask snapshot() override {
    return [u = _u](run::FieldSink& fields) { fields.write("u", 0, u); };
  }
  ExitCode verify(const run::RunDirectory*, run::ResultDocument& result) override {
    double& error = result.errors["linf"];
    for (std::size_t i = 0; i < _u.size(); ++i) error = std::max(error, std::abs(_u[i] - exact(i)));
    if (_data.linf) result.add_check("linf", error, *_data.linf);
    return ExitCode::ok;
  }

 private:
  double exact(std::size_t i) const { return std::exp(-k * k * _now.time) * std::sin(k * _x[i]); }
  void step(double target) {
    const std::size_t n = _u.size();
    const double dx = 1.0 / static_cast<double>(n), left = target - _now.time;
    const double dt = std::min(0.4 * dx * dx, left), c = dt / (dx * dx);
    const auto u = _u;
    for (std::size_t i = 0; i < n; ++i) _u[i] += c * (u[(i + 1) % n] - 2.0 * u[i] + u[(i + n - 1) % n]);
    _now = {_now.step + 1, dt < left ? _now.time + dt : target};
  }
  const HeatData& _data;
  std::vector<double> _x, _u;  // cell centres, m; temperature
  framework::SimulationTime _now;
};

struct HeatScene final : framework::Scene {
  HeatScene(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
    framework::declare_app(_root, "heat", _data.description);
    _root.value("cells", scene::integer_codec(_data.cells), "Number of cells").range(4, 4096);
    _root.value("end_time", scene::real_codec(_data.end_time), "End").unit("s").above(0.0).required();
    _root.value("linf", scene::real_codec(_data.linf), "Tolerance of the largest error").at_least(0.0);
    const auto output = [&](scene::Table& table) { framework::declare_output(table, _data.output, {"u"}); };
    _root.table("output", output, "Files");
    scene::read_file(_root, file, assignments);
    framework::complete_output(_root, _data.output, {"u"}, {_data.end_time, "end_time"});
  }
  std::string print() const override { return scene::print(_root); }
  framework::SceneIdentity identity() const override { return {"cells = " + std::to_string(_data.cells)}; }
  std::unique_ptr<framework::Simulation> create(const framework::SimulationSettings&) const override {
    return std::make_unique<Heat>(_data);
  }

 private:
  HeatData _data;
  scene::Table _root;
};

int main(int argc, char** argv) {
  framework::MiniApp app{.name = "heat", .description = "Heat on a line.", .scene_folder = HEAT_SCENES};
  app.read = [](const auto& file, const auto& sets, bool) { return std::make_unique<HeatScene>(file, sets); };
  return framework::run_mini_app(app, argc, argv);
}
