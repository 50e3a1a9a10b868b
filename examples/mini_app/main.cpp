#include "common/scene/codec.hpp"
#include "common/scene/print.hpp"
#include "common/scene/read.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "miniapps/framework/mini_app.hpp"

// drogue-heat: u_t = u_xx on the unit interval with periodic ends, from sin(2 pi x), by explicit Euler steps.
using namespace drogue;
using namespace drogue::framework;
constexpr double k = 6.283185307179586;  // wave number, 1/m

struct HeatData {
  std::string description;
  std::int64_t cells = 64;
  double end_time = 0.0;  // s
  OutputRequest output;
  std::optional<double> linf;  // tolerance of the error
};

template <class ExecutionSpace>
struct Heat final : Simulation {
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  using HostView = typename View::host_mirror_type;
  /// Step of cell i. c: dt / dx^2, times the diffusivity of 1 m^2/s.
  struct StepFunctor {
    View u, next;  // temperature, K
    double c;
    KOKKOS_FUNCTION void operator()(const int i) const {
      const int n = static_cast<int>(u.extent(0));
      next(i) = u(i) + c * (u((i + 1) % n) - 2.0 * u(i) + u((i + n - 1) % n));
    }
  };

  explicit Heat(const HeatData& data) : _data(data), _n(static_cast<int>(data.cells)) {}
  const OutputRequest& output() const override { return _data.output; }
  EndTime end_time() const override { return {_data.end_time, "end_time"}; }
  void start() override { upload(exact()); }
  void restore(const run::RestartReader& reader) override {
    _now = {reader.integer("step"), reader.number("time")};
    std::vector<double> u(_data.cells);
    reader.read("u", 0, u);
    upload(u);
  }
  void write_restart(run::RestartWriter& writer) override {
    writer.integer("step", _now.step);
    writer.number("time", _now.time);
    writer.array("u", _data.cells);
    writer.write("u", 0, download());
  }
  SimulationTime now() override { return _now; }
  StopReason advance(const AdvanceLimits& limits, const RowSink& rows, const Poll& poll) override {
    while (_now.time < limits.target_time) {
      if (!poll(_now)) return StopReason::interrupted;
      enqueue_step(limits.target_time);
      if (limits.row_every > 0 && _now.step % limits.row_every == 0) rows(row());
      if (_now.step == limits.pause_step) return StopReason::pause;
    }
    return StopReason::target;
  }
  std::vector<run::Column> history_columns() const override { return {{"u_0", "K"}}; }
  HistoryRow row() override { return {_now.time, {download()[0]}}; }
  void write_mesh(run::FieldSink& fields) const override {
    std::vector<double> x(_n);
    for (int i = 0; i < _n; ++i) x[i] = (i + 0.5) / _n;
    fields.add_mesh({"x", {x.size()}, "m", "cell", "cell centres"}, x);
  }
  std::vector<run::DatasetSpec> field_specs() const override { return {{"u", {_u.size()}, "K", "cell", ""}}; }
  FieldsTask snapshot() override {
    return [u = download()](run::FieldSink& to) { to.write("u", 0, u); };
  }
  ExitCode verify(const run::RunDirectory*, run::ResultDocument& result) override {
    const std::vector<double> u = download(), expected = exact();
    double& error = result.errors["linf"];
    for (int i = 0; i < _n; ++i) error = std::max(error, std::abs(u[i] - expected[i]));
    if (_data.linf) result.add_check("linf", error, *_data.linf);
    return ExitCode::ok;
  }

  std::vector<double> exact() const {
    std::vector<double> u(_n);
    for (int i = 0; i < _n; ++i) u[i] = std::exp(-k * k * _now.time) * std::sin(k * (i + 0.5) / _n);
    return u;
  }
  /// Enqueues a step that ends at `target`, s, at the latest. Asynchronous.
  void enqueue_step(double target) {
    const double left = target - _now.time, dt = std::min(0.4 / (_n * _n), left);
    device::launch_each(_instance.space(), "heat::step", _n, StepFunctor{_u, _next, dt * _n * _n});
    std::swap(_u, _next);
    _now = {_now.step + 1, dt < left ? _now.time + dt : target};
  }
  void upload(std::vector<double> u) const { Kokkos::deep_copy(_u, HostView(u.data(), _n)); }
  std::vector<double> download() const {
    const auto u = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), _u);  // waits for all kernels
    return {u.data(), u.data() + _n};
  }
  const HeatData& _data;
  int _n;  // cells
  device::Instance<ExecutionSpace> _instance{1};
  View _u{"heat::u", std::size_t(_n)}, _next{"heat::next", std::size_t(_n)};
  SimulationTime _now;
};

struct HeatScene final : Scene {
  HeatScene(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
    declare_app(_root, "heat", _data.description);
    _root.value("cells", _data.cells, "Number of cells", {.range = scene::between(4, 4096)});
    _root.value("end_time", _data.end_time, "End", {.unit = "s", .range = scene::positive, .required = true});
    _root.value("linf", _data.linf, "Tolerance of the largest error", {.range = scene::not_negative});
    _root.table(
        "output", [this](scene::Table& t) { declare_output(t, _data.output, {"u"}); }, "Files");
    scene::read_file(_root, file, assignments);
    complete_output(_root, _data.output, {"u"}, {_data.end_time, "end_time"});
  }
  std::string print() const override { return scene::print(_root); }
  SceneIdentity identity() const override { return {"cells = " + std::to_string(_data.cells)}; }
  std::unique_ptr<Simulation> create(const SimulationSettings& settings) const override {
    return device::dispatch(settings.backend, [this]<class Space>() -> std::unique_ptr<Simulation> {
      return std::make_unique<Heat<Space>>(_data);
    });
  }

  HeatData _data;
  scene::Table _root;
};

int main(int argc, char** argv) {
  MiniApp app{.name = "heat", .description = "Heat on a line.", .scene_folder = HEAT_SCENES};
  app.read = [](const auto& file, const auto& sets, bool) { return std::make_unique<HeatScene>(file, sets); };
  return run_mini_app(app, argc, argv);
}
