#include "perf/messages/messages.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/flow/halo/halo.hpp"
#include "kernels/flow/make_grid.hpp"
#include "kernels/linear/poisson/pencil_transpose.hpp"

namespace drogue::perf::messages {
namespace {

flow::Parameters periodic_flow(const std::array<int, 3>& cells) {
  flow::Parameters p;
  p.cells = cells;
  return p;
}

/// Messages of a direct pressure solver on ranks that divide y.
template <class ExecutionSpace>
class Transpositions {
 public:
  Transpositions(const linear::RankGroup& group, const linear::PencilRanks& ranks,
                 const std::array<int, 3>& cells) {
    linear::CellBox box = linear::box_of(ranks, cells);
    for (const std::size_t axis : {1U, 2U}) {
      const linear::RankGroup line = group.split(axis == 1 ? ranks.place[2] : ranks.place[1]);
      if (line.size() == 1) continue;
      _turns.emplace_back(line, box, axis, cells[axis], axis == 2 && box.cells[1] >= box.cells[0] ? 1 : 0);
      _most = std::max({_most, box.size(), _turns.back().after().size()});
      box = _turns.back().after();
    }
    for (auto* array : {&_from, &_to}) *array = List("drogue::perf::transposed", _most);
    for (auto* buffer : {&_send, &_receive}) *buffer = Buffer("drogue::perf::transposed", _most);
  }

  void run(const ExecutionSpace& space) const {
    for (const auto& turn : _turns) turn.forward(space, _from, _to, _send, _receive);
    for (auto turn = _turns.rbegin(); turn != _turns.rend(); ++turn)
      turn->backward(space, _from, _to, _send, _receive);
  }

 private:
  using List = flow::List<ExecutionSpace>;
  using Buffer = linear::HostBuffer<ExecutionSpace>;
  std::vector<linear::PencilTranspose<ExecutionSpace>> _turns;
  std::size_t _most = 0;
  List _from, _to;
  Buffer _send, _receive;
};

template <class ExecutionSpace>
class MessagesOf final : public Messages {
 public:
  MessagesOf(const std::array<int, 3>& cells, const linear::RankGroup& group)
      : _parameters(periodic_flow(cells)),
        _ranks(flow::ranks_of(_parameters, group.size(), group.rank(), !device::is_host<ExecutionSpace>)),
        _grid(flow::make_grid(_parameters, _ranks)),
        _halo(space(), group, _ranks, _parameters, _grid),
        _velocity("drogue::perf::velocity", static_cast<std::size_t>(3 * _grid.component)),
        _pressure("drogue::perf::pressure", static_cast<std::size_t>(_grid.cells())),
        _sources("drogue::perf::sources", static_cast<std::size_t>(group.size() * source_count())),
        _buffer("drogue::perf::exchanged", 4 * static_cast<std::size_t>(exchanged() / 2.0)) {
    for (const List& list : {_velocity, _pressure, _sources})
      Kokkos::deep_copy(space(), list, static_cast<double>(group.rank()));
    if (!_ranks.are_slabs()) _transpositions.emplace(group, _ranks, cells);
    space().fence("drogue::perf::messages: filled");
  }

  void run_steps(long count) override {
    repeat(_step, count, [this](const ExecutionSpace& s) { enqueue_step(s); });
  }
  void run_shortest(long count) override {
    repeat(_shortest, count, [this](const ExecutionSpace& s) { enqueue_exchange(s, 1); });
  }
  void run_exchanges(long count) override {
    const std::size_t to_each = _buffer.size() / 4;
    repeat(_exchange, count, [this, to_each](const ExecutionSpace& s) { enqueue_exchange(s, to_each); });
  }

  [[nodiscard]] double sent_in_step() const override {
    return flow::numbers_sent(_parameters.cells, _ranks.parts[1], _ranks.parts[2]);
  }
  [[nodiscard]] double exchanged() const override {
    return 2.0 * static_cast<double>(static_cast<std::size_t>(0.5 * sent_in_step()));
  }
  [[nodiscard]] std::array<int, 3> parts() const override { return _ranks.parts; }
  [[nodiscard]] linear::Transport transport() const override { return communicator().transport(); }

  [[nodiscard]] double wrong_values() override {
    double wrong = 0.0;
    const auto count = [&](const std::vector<double>& values, std::size_t from, std::size_t to, int sender) {
      for (std::size_t i = from; i < to; ++i) wrong += values[i] == sender ? 0.0 : 1.0;
    };
    const std::vector<double> velocity = on_host(_velocity), sources = on_host(_sources);
    for (const std::size_t axis : {1U, 2U}) {
      if (!flow::borders_rank(_parameters, _ranks, 2 * axis)) continue;
      linear::PencilRanks below = _ranks;
      below.place = flow::place_beyond(_ranks, 2 * axis);
      const int sender = below.rank_at(below.place);
      const std::size_t layer = _pressure.size() / static_cast<std::size_t>(_grid.n[axis]);
      const Unmanaged received(_halo.pressure_below()[axis], layer);
      count(on_host(received), 0, layer, sender);
      std::array<int, 3> ghost = {0, 0, 0};
      ghost[axis] = -flow::ghost_width;
      const auto first = static_cast<std::size_t>(_grid.offset(ghost[0], ghost[1], ghost[2]));
      count(velocity, first, first + static_cast<std::size_t>(_grid.n[0]), sender);
    }
    if (_ranks.are_slabs())
      for (int rank = 0; rank < _halo.group().size(); ++rank) {
        const std::size_t begin = static_cast<std::size_t>(rank) * static_cast<std::size_t>(source_count());
        count(sources, begin, begin + static_cast<std::size_t>(source_count()), rank);
      }
    auto bits = static_cast<std::uint64_t>(wrong);
    _halo.group().maximize({&bits, 1});
    return static_cast<double>(bits);
  }

 private:
  using List = flow::List<ExecutionSpace>;
  using Unmanaged = Kokkos::View<const double*, typename ExecutionSpace::memory_space,
                                 Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  using Graph = std::optional<device::CapturedGraph<ExecutionSpace>>;

  [[nodiscard]] const ExecutionSpace& space() const { return _instance.space(); }
  [[nodiscard]] const auto& communicator() const { return _halo.communicator(); }
  /// Two numbers per line along z.
  [[nodiscard]] int source_count() const {
    return _ranks.are_slabs() ? 2 * _parameters.cells[0] * _parameters.cells[1] : 0;
  }

  /// As in `flow::Step` with AB2.
  void enqueue_step(const ExecutionSpace& s) {
    _halo.outdate_velocity();
    _halo.finish_velocity(s, _velocity);
    _halo.exchange_high_faces(s, _velocity);
    if (_transpositions)
      _transpositions->run(s);
    else
      communicator().gather(s, _sources.data() + _halo.group().rank() * source_count(), _sources.data(),
                            static_cast<std::size_t>(source_count()));
    _halo.exchange_pressure_and_agree(s, _pressure, _control, false);
    _halo.agree(s, _control, false);
  }

  /// `count` numbers to each of both neighbours.
  void enqueue_exchange(const ExecutionSpace& s, std::size_t count) {
    const int ranks = _halo.group().size(), own = _halo.group().rank();
    const std::size_t place = _buffer.size() / 4;
    const auto part = [&](std::size_t which) { return std::span(_buffer.data() + which * place, count); };
    const linear::Message messages[] = {
        {.peer = (own + 1) % ranks, .send_tag = 0, .receive_tag = 1, .send = part(0), .receive = part(1)},
        {.peer = (own + ranks - 1) % ranks,
         .send_tag = 1,
         .receive_tag = 0,
         .send = part(2),
         .receive = part(3)}};
    communicator().exchange(s, messages);
  }

  void repeat(Graph& graph, long count, const std::function<void(const ExecutionSpace&)>& enqueue) {
    if (communicator().is_asynchronous() && !graph) {
      enqueue(space());  // connections are made in the first messages
      space().fence("drogue::perf::messages: connected");
      graph.emplace(_instance, enqueue);
    }
    for (long i = 0; i < count; ++i) {
      if (graph)
        graph->launch();
      else
        enqueue(space());
    }
    space().fence("drogue::perf::messages: complete");
  }

  template <class View>
  [[nodiscard]] std::vector<double> on_host(const View& list) const {
    std::vector<double> values(list.size());
    device::copy_out(space(), values.data(), list, values.size());
    space().fence("drogue::perf::messages: copied");
    return values;
  }

  device::Instance<ExecutionSpace> _instance{1 << 10};
  flow::Parameters _parameters;
  linear::PencilRanks _ranks;
  flow::MacGrid _grid;
  flow::Halo<ExecutionSpace> _halo;
  List _velocity, _pressure, _sources, _buffer;
  flow::ControlView<ExecutionSpace> _control{"drogue::perf::control"};
  std::optional<Transpositions<ExecutionSpace>> _transpositions;
  Graph _step, _shortest, _exchange;
};

}  // namespace

std::unique_ptr<Messages> create_messages(device::Backend backend, const std::array<int, 3>& cells,
                                          const linear::RankGroup& group) {
  return device::dispatch(backend, [&]<class ExecutionSpace>() -> std::unique_ptr<Messages> {
    return std::make_unique<MessagesOf<ExecutionSpace>>(cells, group);
  });
}

}  // namespace drogue::perf::messages
