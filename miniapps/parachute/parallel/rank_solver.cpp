#include "miniapps/parachute/parallel/rank_solver.hpp"

#include <algorithm>
#include <utility>

#include "common/program/failure.hpp"
#include "common/program/message.hpp"
#include "common/run/hdf5/shared_write.hpp"
#include "miniapps/parachute/parallel/parameters_message.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

constexpr int root = 0;

std::size_t as_size(int n) { return static_cast<std::size_t>(n); }

/// Number of components of a field at the cell centres.
std::size_t components(flow::CellField field) {
  return field == flow::CellField::velocity || field == flow::CellField::vorticity ? 3 : 1;
}

/// Copies a part of a whole array, whose first axis is fastest and undivided, from or to an array of its own.
template <class Shape, class Part, class Copy>
void for_each_row(const Shape& whole, const Part& part, const Copy& copy) {
  const std::size_t row = part.extent[0] * part.extent[1];
  std::size_t at = 0;
  for (std::size_t k = 0; k < part.extent[3]; ++k)
    for (std::size_t j = 0; j < part.extent[2]; ++j, at += row)
      copy(whole.extent[0] * (part.begin[1] +
                              whole.extent[1] * (part.begin[2] + j + whole.extent[2] * (part.begin[3] + k))),
           at, row);
}

}  // namespace

RankSolver::RankSolver(Communicator& communicator, device::Backend backend,
                       const coupling::Parameters& parameters, const std::function<void()>& prepare)
    : _communicator(communicator), _parameters(parameters.flow) {
  communicator.run_collectively(prepare);
  communicator.run_collectively([&] {
    _group = linear::RankGroup::world();
    if (parameters.fabric.mass.empty()) {
      _solver = with_usage_error([&] { return flow::create_solver(backend, parameters.flow, _group); });
    } else {
      auto coupled = with_usage_error([&] { return coupling::create_solver(backend, parameters, _group); });
      _coupled = coupled.get();
      _solver = std::move(coupled);
    }
  });
}

linear::CellBox RankSolver::box(flow::StateField field, int rank) const {
  return flow::part_of(_parameters, flow::ranks_of(_parameters, _group.size(), rank), field);
}

RankSolver::Part RankSolver::state_part(flow::StateField field, int rank) const {
  const linear::CellBox own = box(field, rank);
  return {{0, as_size(own.begin[0]), as_size(own.begin[1]), as_size(own.begin[2])},
          {1, as_size(own.cells[0]), as_size(own.cells[1]), as_size(own.cells[2])}};
}

RankSolver::Part RankSolver::sample_part(flow::CellField field, int rank) const {
  const linear::CellBox own = box(flow::StateField::pressure, rank);
  return {{0, as_size(own.begin[2]), as_size(own.begin[1]), as_size(own.begin[0])},
          {components(field), as_size(own.cells[2]), as_size(own.cells[1]), as_size(own.cells[0])}};
}

void RankSolver::upload(flow::StateField field, std::span<const double> whole) {
  run([&] {
    const std::array<int, 3> n = flow::extents(_parameters, field);
    const Part shape{{}, {1, as_size(n[0]), as_size(n[1]), as_size(n[2])}};
    std::vector<double> own(state_part(field, _group.rank()).size());
    if (_group.rank() == root) {
      for (int rank = _group.size() - 1; rank >= 0; --rank) {
        const Part part = state_part(field, rank);
        own.resize(part.size());
        for_each_row(shape, part, [&](std::size_t from, std::size_t to, std::size_t row) {
          std::copy_n(whole.data() + from, row, own.data() + to);
        });
        const linear::Message message{rank, 0, 0, own, {}};
        if (rank != root) _group.exchange({&message, 1});
      }
    } else {
      const linear::Message message{root, 0, 0, {}, own};
      _group.exchange({&message, 1});
    }
    _solver->upload(field, own);
  });
}

void RankSolver::upload_function(std::size_t axis, const std::string& text) {
  run([&] {
    const flow::StateField field = velocity_field(axis);
    const linear::CellBox own = box(field, _group.rank());
    Lattice lattice = lattice_of(_parameters, field);
    lattice.n = own.cells;
    lattice.origin = own.begin;
    _solver->upload(field, evaluate(SpaceTimeFunction(text), lattice, 0.0));
  });
}

/// Brings the parts of all ranks together on rank 0.
template <class PartOf>
void RankSolver::collect(const std::vector<double>& own, std::span<double> whole, const Part& shape,
                         const PartOf& part_of) const {
  if (_group.rank() != root) {
    const linear::Message message{root, 0, 0, own, {}};
    return _group.exchange({&message, 1});
  }
  std::vector<double> received = own;
  for (int rank = 0; rank < _group.size(); ++rank) {
    const Part part = part_of(rank);
    received.resize(part.size());
    const linear::Message message{rank, 0, 0, {}, received};
    if (rank != root) _group.exchange({&message, 1});
    for_each_row(shape, part, [&](std::size_t to, std::size_t from, std::size_t row) {
      std::copy_n(received.data() + from, row, whole.data() + to);
    });
  }
}

void RankSolver::download(flow::StateField field, std::span<double> whole) {
  run([&] {
    const std::array<int, 3> n = flow::extents(_parameters, field);
    std::vector<double> own(state_part(field, _group.rank()).size());
    _solver->download(field, own);
    collect(own, whole, {{}, {1, as_size(n[0]), as_size(n[1]), as_size(n[2])}},
            [&](int rank) { return state_part(field, rank); });
  });
}

void RankSolver::sample(flow::CellField field, std::span<double> whole) {
  run([&] {
    const std::array<int, 3>& n = _parameters.cells;
    std::vector<double> own(sample_part(field, _group.rank()).size());
    _solver->sample(field, own);
    collect(own, whole, {{}, {components(field), as_size(n[2]), as_size(n[1]), as_size(n[0])}},
            [&](int rank) { return sample_part(field, rank); });
  });
}

void RankSolver::write(flow::CellField field, std::uint64_t offset, const std::string& file) {
  const linear::CellBox own = box(flow::StateField::pressure, _group.rank());
  std::vector<double> values(own.size() * components(field));
  run([&] { _solver->sample(field, values); });
  run::ArrayPart part;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    part.whole.push_back(as_size(_parameters.cells[axis]));
    part.begin.push_back(as_size(own.begin[axis]));
    part.extent.push_back(as_size(own.cells[axis]));
  }
  part.whole.push_back(components(field));
  part.begin.push_back(0);
  part.extent.push_back(components(field));
  run::write_parts(file, offset, part, values);
}

template <class... Values>
void SharedSolver::request(Request request, const Values&... values) {
  MessageWriter message;
  message.put(request);
  (message.put(values), ...);
  static_cast<void>(_communicator.broadcast(message.take()));
}

SharedSolver::SharedSolver(Communicator& communicator, device::Backend backend,
                           const coupling::Parameters& parameters)
    : _communicator(communicator) {
  with_usage_error([&] { return flow::ranks_of(parameters.flow, communicator.size(), root); });
  MessageWriter message;
  message.put(Request::create);
  message.put(backend);
  put_parameters(message, parameters);
  static_cast<void>(communicator.broadcast(message.take()));
  _own = std::make_unique<RankSolver>(communicator, backend, parameters, [] {});
}

SharedSolver::~SharedSolver() { request(Request::destroy); }

void SharedSolver::upload(std::size_t axis, const std::string& text) {
  MessageWriter message;
  message.put(Request::upload_function);
  message.put(axis);
  message.put_text(text);
  static_cast<void>(_communicator.broadcast(message.take()));
  _own->upload_function(axis, text);
}

void SharedSolver::write(flow::CellField field, std::uint64_t offset, const std::string& file) {
  MessageWriter message;
  message.put(Request::write);
  message.put(field);
  message.put(offset);
  message.put_text(file);
  static_cast<void>(_communicator.broadcast(message.take()));
  _own->write(field, offset, file);
}

void SharedSolver::upload(flow::StateField field, std::span<const double> values) {
  request(Request::upload, field);
  _own->upload(field, values);
}

void SharedSolver::download(flow::StateField field, std::span<double> values) {
  request(Request::download, field);
  _own->download(field, values);
}

void SharedSolver::start() {
  request(Request::start);
  _own->run([&] { _own->solver().start(); });
}

void SharedSolver::restore(const flow::Progress& progress) {
  request(Request::restore, progress);
  _own->run([&] { _own->solver().restore(progress); });
}

flow::Stop SharedSolver::advance(double target, std::int64_t pause_step, const flow::Poll& poll) {
  request(Request::advance, target, pause_step);
  return _own->run([&] { return _own->solver().advance(target, pause_step, poll); });
}

flow::Totals SharedSolver::totals() {
  request(Request::totals);
  return _own->run([&] { return _own->solver().totals(); });
}

void SharedSolver::sample(flow::CellField field, std::span<double> values) {
  request(Request::sample, field);
  _own->sample(field, values);
}

void SharedSolver::request_with(Request request,
                                std::initializer_list<std::span<const fabric::Vector>> arrays) {
  MessageWriter message;
  message.put(request);
  for (const auto& rows : arrays) message.put_all(std::vector<fabric::Vector>(rows.begin(), rows.end()));
  static_cast<void>(_communicator.broadcast(message.take()));
}

void SharedSolver::upload_cloth(std::span<const fabric::Vector> positions,
                                std::span<const fabric::Vector> velocities) {
  request_with(Request::upload_cloth, {positions, velocities});
  _own->run([&] { _own->coupled().upload_cloth(positions, velocities); });
}

void SharedSolver::upload(std::string_view name, std::span<const double> values) {
  MessageWriter message;
  message.put(Request::upload_array);
  message.put_text(std::string(name));
  message.put_all(std::vector<double>(values.begin(), values.end()));
  static_cast<void>(_communicator.broadcast(message.take()));
  _own->run([&] { _own->coupled().upload(name, values); });
}

void SharedSolver::set_block(const coupling::BlockProgress& block) {
  request(Request::set_block, block);
  _own->run([&] { _own->coupled().set_block(block); });
}

void SharedSolver::set_frame(const coupling::FrameMotion& frame) {
  request(Request::set_frame, frame);
  _own->run([&] { _own->coupled().set_frame(frame); });
}

std::array<double, 3> SharedSolver::total_force_on_air() {
  request(Request::total_force_on_air);
  return _own->run([&] { return _own->coupled().total_force_on_air(); });
}

void SharedSolver::air_velocity(std::span<fabric::Vector> at_vertices) {
  request(Request::air_velocity, at_vertices.size());
  _own->run([&] { _own->coupled().air_velocity(at_vertices); });
}

}  // namespace drogue::parachute_app
