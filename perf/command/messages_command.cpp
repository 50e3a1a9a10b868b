#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <bit>
#include <cstdio>
#include <memory>

#include "common/program/communicator.hpp"
#include "common/program/signals.hpp"
#include "common/run/files/atomic_file.hpp"
#include "kernels/device/stopwatch.hpp"
#include "perf/command/command.hpp"
#include "perf/measure/record.hpp"
#include "perf/measure/rounds.hpp"
#include "perf/messages/messages.hpp"
#include "perf/models/messages.hpp"
#include "perf/problems/streams.hpp"
#include "perf/rows/printed.hpp"
#include "perf/rows/rows.hpp"

namespace drogue::perf {
namespace {

struct MessagesOptions {
  std::string backend = "auto", out;
  std::vector<int> cells = {64, 64, 64};
  bool quick = false;
};

/// Kind of messages and its samples, s.
struct TimedMessages {
  std::string name, unit;
  double bytes;  ///< that a rank sends in a unit
  std::function<void(long)> run;
  std::vector<double> samples = {};
  long repeats = 1;
};

/// Seconds of the slowest rank, the same on all.
double slowest_time(const linear::RankGroup& group, const std::function<void()>& work) {
  static_cast<void>(group.all(true));  // all ranks begin together
  const device::Stopwatch watch;
  work();
  auto bits = std::bit_cast<std::uint64_t>(watch.seconds());  // ordered as the numbers, which are positive
  group.maximize({&bits, 1});
  return std::bit_cast<double>(bits);
}

/// Samples of all kinds in turn, after two rounds without.
void measure(const linear::RankGroup& group, std::vector<TimedMessages>& kinds, bool quick) {
  for (int round = -2; round < kept_rounds(quick); ++round)
    for (TimedMessages& kind : kinds) {
      const double seconds =
          slowest_time(group, [&] { kind.run(kind.repeats); }) / static_cast<double>(kind.repeats);
      if (round >= 0)
        kind.samples.push_back(seconds);
      else
        kind.repeats = repeats_of(seconds, seconds);
    }
}

/// Measures on all ranks, and prints on rank 0.
Table measure_messages(const MessagesOptions& options, device::Backend backend, Communicator& communicator) {
  const linear::RankGroup group = linear::RankGroup::world();
  const std::array<int, 3> cells = {options.cells[0], options.cells[1], options.cells[2]};
  std::unique_ptr<messages::Messages> messages;
  try {
    messages = messages::create_messages(backend, cells, group);
  } catch (const std::invalid_argument& error) {  // on all ranks
    throw Failure(ExitCode::usage, error.what());
  }
  const std::string name(device::name(backend)), ranks = "/ranks/" + std::to_string(group.size());
  constexpr double bytes = sizeof(double);
  std::vector<TimedMessages> kinds = {
      {"messages/latency/" + name + ranks, "exchange", 2.0 * bytes,
       [&](long count) { messages->run_shortest(count); }},
      {"messages/exchange/" + name + "/" + streams::text(cells) + ranks, "exchange",
       bytes * messages->exchanged(), [&](long count) { messages->run_exchanges(count); }},
      {"messages/flow-step/" + name + "/" + streams::text(cells) + ranks, "step",
       bytes * messages->sent_in_step(), [&](long count) { messages->run_steps(count); }}};
  measure(group, kinds, options.quick);
  const double wrong = messages->wrong_values();
  Table table;
  if (!communicator.is_root()) return table;
  const nlohmann::json here = provenance(device::device_facts());
  const std::string transport(linear::name(messages->transport()));
  std::printf("Messages between %d ranks by %s\n%-52s%14s  %-28s %11s\n", group.size(), transport.c_str(),
              "case", "us", "95 %", "kB");
  for (const TimedMessages& kind : kinds) {
    const bool is_step = &kind == &kinds.back();
    const Record record{.name = kind.name,
                        .unit_of_work = kind.unit,
                        .bound = "latency and bandwidth between ranks",
                        .samples = kind.samples,
                        .error = is_step ? wrong : 0.0,
                        .tolerance = 0.0};
    table.add(record, here,
              {{"backend", name},
               {"ranks", group.size()},
               {"bytes", kind.bytes},
               {"rounds", is_step ? message_rounds(messages->parts()) : 1},
               {"transport", transport}});
    std::printf("%-52s%14s  %-28s %11.2f\n", kind.name.c_str(), median_text(record, 1e6, 2).c_str(),
                interval_text(record, 1e6, 2).c_str(), 1e-3 * kind.bytes);
  }
  return table;
}

ExitCode run_on_all_ranks(const MessagesOptions& options, const std::vector<std::string>& kokkos) {
  Communicator communicator;
  install_signal_handlers();
  try {
    if (communicator.size() == 1)
      throw Failure(ExitCode::usage,
                    "one rank has no messages: start several, mpirun -n 2 drogue-perf messages");
    device::Backend backend{};
    communicator.run_collectively([&] {
      backend = device::wanted_backend(options.backend);
      require(backend);
    });
    communicator.run_on_root([&] { run::require_writable(options.out); });
    const device::Runtime runtime(kokkos);
    Table table;
    communicator.run_or_abort([&] { table = measure_messages(options, backend, communicator); });
    communicator.run_on_root([&] { write_records(options.out, table.records); });
    return communicator.is_root() ? code_of(table.passed) : ExitCode::ok;
  } catch (const Failure&) {
    // All ranks throw the same failure; rank 0 reports it.
    if (communicator.is_root()) throw;
    return ExitCode::ok;
  }
}

}  // namespace

Command messages_command(CLI::App& program) {
  const auto options = std::make_shared<MessagesOptions>();
  CLI::App* app = program.add_subcommand(
      "messages", "Under mpirun: time of the messages of steps of flow alone, beside latency and bandwidth");
  app->add_option("--backend", options->backend, "Where the messages begin and end")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app->add_option("--cells", options->cells, "Cells of the periodic box that the ranks share")
      ->expected(3)
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  app->add_option("--out", options->out, "File for the records, one JSON line a row");
  app->add_flag("--quick", options->quick, "Few samples");
  return {app,
          [options](const std::vector<std::string>& kokkos) { return run_on_all_ranks(*options, kokkos); }};
}

}  // namespace drogue::perf
