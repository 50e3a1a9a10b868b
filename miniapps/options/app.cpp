#include "miniapps/options/app.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <thread>

#include "common/program/communicator.hpp"
#include "common/program/message.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "common/program/signals.hpp"
#include "common/run/output_path.hpp"
#include "common/run/result_document.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/device/runtime.hpp"
#include "miniapps/options/batch_run.hpp"
#include "miniapps/options/batches.hpp"
#include "miniapps/options/distribution.hpp"
#include "miniapps/options/summary.hpp"

namespace drogue::options_app {
namespace {

using Clock = std::chrono::steady_clock;

device::Backend choose_backend(const std::string& wanted) {
  const device::Backend backend = device::wanted_backend(wanted);
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
  return backend;
}

std::unique_ptr<device::Runtime> start_kokkos(const std::vector<std::string>& arguments) {
  return made_as_asked([&] { return std::make_unique<device::Runtime>(arguments); });
}

std::unique_ptr<options::Pricer> make_pricer(device::Backend backend, options::Settings settings,
                                             const Communicator& ranks) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  settings.host_threads = std::max(1, cores / ranks.ranks_on_host());
  return made_as_asked([&] { return options::create_pricer(backend, settings); });
}

/// Then a summary there would stand among rows.
bool writes_to_standard_output(const Command& command) {
  for (const std::filesystem::path* path : {&command.out, &command.result, &command.boundary})
    if (run::is_same_file(*path, "/proc/self/fd/1")) return true;
  return false;
}

void describe_spent(const Spent& spent, double seconds, run::ResultDocument& result) {
  result.timing.h2d_s = spent.timing.h2d;
  result.timing.compute_s = spent.timing.compute;
  result.timing.d2h_s = spent.timing.d2h;
  result.timing.io_s = std::max(0.0, seconds - spent.pricing / result.ranks);
  result.describe_ledger(spent.ledger);
}

/// What the first rank tells the others of the batch.
std::string batch_message(device::Backend backend, const std::optional<BatchReader>& reader) {
  MessageWriter message;
  message.put(backend);
  message.put_all(reader ? reader->places() : std::vector<int>());
  return message.take();
}

/// Reads, prices, writes. `result` is filled also where rows did not end well, which is thrown.
ExitCode price_batch(Communicator& ranks, const Command& command, const std::filesystem::path& input,
                     run::ResultDocument& result) {
  const auto begin = Clock::now();
  const RowKind kind = command.action == Action::price ? RowKind::contract : RowKind::parameter_set;
  const auto since = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  device::Backend backend{};
  std::optional<BatchReader> reader;
  std::optional<Outputs> outputs;
  ranks.run_collectively([&] {
    if (!ranks.is_root()) return;
    reader.emplace(input, kind);
    if (reader->has_ids()) BatchReader(input, kind).require_unique_ids();
    backend = choose_backend(command.backend);
    outputs.emplace(command);
  });
  // One backend on all ranks, whatever each would choose: prices have the bits of one backend.
  const std::string message = ranks.broadcast(batch_message(backend, reader));
  MessageReader facts(message);
  backend = facts.get<device::Backend>();
  const auto places = facts.get_all<int>();
  std::unique_ptr<device::Runtime> runtime;
  std::unique_ptr<options::Pricer> pricer;
  ranks.run_collectively([&] {
    choose_backend(std::string(device::name(backend)));
    runtime = start_kokkos(command.kokkos);
    device::start_profiling();
    result.describe_device(std::string(device::name(backend)), device::device_facts());
    pricer = make_pricer(backend, command.settings, ranks);
  });
  result.timing.setup_s = since(begin);
  const auto pricing = Clock::now();
  BatchRun run(command, kind, places, *pricer);
  Distribution done;
  ranks.run_collectively([&] {
    if (!ranks.is_root()) return assist(ranks, run);
    done = distribute(ranks, command, *reader, *outputs, run);
    if (done.is_complete) outputs->commit();
  });
  if (!ranks.is_root()) return ExitCode::ok;
  describe_spent(done.spent, since(pricing), result);
  result.timing.wall_s = since(begin);
  count_rows(outputs->tally(), result);
  if (!done.is_complete) {
    result.message = "interrupted by a signal; " +
                     std::string(run::is_replaced(command.out) ? "nothing" : "not all") + " is written to '" +
                     command.out.string() + "'";
    return ExitCode::interrupted;
  }
  if (!command.quiet && !writes_to_standard_output(command))
    print_summary(command, result, outputs->tally(), reader->rows());
  require_priced_rows(command, outputs->tally(), *reader);
  return ExitCode::ok;
}

/// One batch, whose --result tells how it ended, whatever happened.
ExitCode run_batch(Communicator& ranks, const Command& command) {
  std::filesystem::path input;
  ranks.run_collectively([&] {
    if (!ranks.is_root()) return;
    input = find_batch(command.input);
    check_outputs(command, input);
  });
  run::ResultDocument result = run::new_result("drogue-options", input.stem().string());
  result.metrics.add_group("counts");
  // The schema of result.json holds the counts of a flux limiter for every program.
  for (const char* count : {"touches", "cells", "redone_steps"})
    result.metrics.set("limiter", count, std::int64_t{0});
  result.ranks = ranks.size();
  const auto write_result = [&] {
    if (ranks.is_root() && !command.result.empty()) run::write_result(command.result, result);
  };
  try {
    result.exit_code = price_batch(ranks, command, input, result);
  } catch (...) {
    const Failure failure = current_failure();
    result.exit_code = failure.code();
    result.message = failure.what();
    try {
      write_result();
    } catch (const Failure& second) {
      throw Failure(failure.code(), std::string(failure.what()) + "; and " + second.what());
    }
    throw failure;
  }
  write_result();
  return result.exit_code;
}

}  // namespace

ExitCode run_app(const Command& command) {
  const auto say = [](const std::string& text) {
    std::cout << text;
    return ExitCode::ok;
  };
  switch (command.action) {
    case Action::help:
      return say(command.help);
    case Action::version:
      return say(version_text("drogue-options"));
    case Action::list_batches:
      return say(batch_list());
    case Action::price:
    case Action::surface:
      break;
  }
  Communicator ranks;
  install_signal_handlers();
  try {
    return run_batch(ranks, command);
  } catch (const Failure&) {
    // The first rank throws the same, and tells it.
    if (ranks.is_root()) throw;
    return ExitCode::ok;
  }
}

}  // namespace drogue::options_app
