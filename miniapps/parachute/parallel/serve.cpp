#include "miniapps/parachute/parallel/serve.hpp"

#include <memory>
#include <optional>

#include "common/program/failure.hpp"
#include "common/program/message.hpp"
#include "common/program/signals.hpp"
#include "miniapps/framework/device_session.hpp"
#include "miniapps/parachute/parallel/parameters_message.hpp"
#include "miniapps/parachute/parallel/rank_solver.hpp"

namespace drogue::parachute_app {
namespace {

/// The solver of a rank other than 0.
class Worker {
 public:
  Worker(Communicator& communicator, const MiniAppOptions& options)
      : _communicator(communicator), _options(options) {}

  void execute(MessageReader message) {
    const auto request = message.get<Request>();
    switch (request) {
      case Request::create:
        return create(message);
      case Request::destroy:
        return _solver.reset();
      case Request::upload:
        return _solver->upload(message.get<flow::StateField>(), {});
      case Request::upload_function: {
        const auto axis = message.get<std::size_t>();
        return _solver->upload_function(axis, message.get_text());
      }
      case Request::download:
        return _solver->download(message.get<flow::StateField>(), {});
      case Request::sample:
        return _solver->sample(message.get<flow::CellField>(), {});
      case Request::write: {
        const auto field = message.get<flow::CellField>();
        const auto offset = message.get<std::uint64_t>();
        return _solver->write(field, offset, message.get_text());
      }
      case Request::start:
      case Request::restore:
      case Request::advance:
      case Request::totals:
        return _solver->run([&] { step(request, message); });
      case Request::upload_cloth:
      case Request::upload_array:
      case Request::set_block:
      case Request::set_frame:
      case Request::total_force_on_air:
      case Request::air_velocity:
        return _solver->run([&] { couple(request, message); });
    }
  }

 private:
  void create(MessageReader& message) {
    const auto backend = message.get<device::Backend>();
    const coupling::Parameters parameters = get_parameters(message);
    _solver.emplace(_communicator, backend, parameters, [&] {
      framework::require_backend(backend);
      if (!_session) _session = std::make_unique<framework::DeviceSession>(backend, _options.kokkos);
    });
  }

  void step(Request request, MessageReader& message) {
    flow::Solver& solver = _solver->solver();
    if (request == Request::start) {
      solver.start();
    } else if (request == Request::restore) {
      solver.restore(message.get<flow::Progress>());
    } else if (request == Request::totals) {
      static_cast<void>(solver.totals());
    } else {
      const auto target = message.get<double>();
      const auto pause_step = message.get<std::int64_t>();
      static_cast<void>(
          solver.advance(target, pause_step, [](const flow::Status&) { return !interrupted(); }));
    }
  }

  void couple(Request request, MessageReader& message) {
    coupling::Solver& solver = _solver->coupled();
    if (request == Request::upload_cloth) {
      const auto positions = message.get_all<fabric::Vector>();
      solver.upload_cloth(positions, message.get_all<fabric::Vector>());
    } else if (request == Request::upload_array) {
      const std::string name = message.get_text();
      solver.upload(name, message.get_all<double>());
    } else if (request == Request::set_block) {
      solver.set_block(message.get<coupling::BlockProgress>());
    } else if (request == Request::set_frame) {
      solver.set_frame(message.get<coupling::FrameMotion>());
    } else if (request == Request::air_velocity) {
      std::vector<fabric::Vector> same_on_all_ranks(message.get<std::size_t>());
      solver.air_velocity(same_on_all_ranks);
    } else {
      static_cast<void>(solver.total_force_on_air());
    }
  }

  Communicator& _communicator;
  const MiniAppOptions& _options;
  std::unique_ptr<framework::DeviceSession> _session;  ///< ends after the solver
  std::optional<RankSolver> _solver;
};

}  // namespace

void serve(Communicator& communicator, const MiniAppOptions& options) {
  Worker worker(communicator, options);
  while (true) {
    const std::string message = communicator.broadcast({});
    if (message.empty()) return;
    try {
      worker.execute(MessageReader(message));
    } catch (const Failure&) {
      // All ranks throw the same failure. Rank 0 reports it and ends the others.
    }
  }
}

}  // namespace drogue::parachute_app
