#include "miniapps/options/batch_run.hpp"

#include <algorithm>
#include <optional>
#include <thread>

#include "common/program/message.hpp"
#include "common/program/program.hpp"
#include "common/program/stopwatch.hpp"
#include "common/run/files/output_path.hpp"
#include "common/run/result_document.hpp"
#include "miniapps/framework/device_session.hpp"
#include "miniapps/framework/metrics.hpp"
#include "miniapps/options/input/shipped_batches.hpp"
#include "miniapps/options/output/summary.hpp"
#include "miniapps/options/parallel/rank_pricing.hpp"

namespace drogue::options_app {
namespace {

RowKind row_kind(const Command& command) {
  return command.action == Action::price ? RowKind::contract : RowKind::parameter_set;
}

/// Number of host threads that pay: a single contract is the work of one.
int useful_threads(const Command& command, const std::filesystem::path& input) {
  const bool is_one = command.action == Action::price && !has_several_rows(input, row_kind(command));
  return is_one ? 1 : static_cast<int>(std::thread::hardware_concurrency());
}

/// Input and output files, which rank 0 holds, and the facts about them that all ranks share.
struct OpenBatch {
  /// Opens the files and chooses the backend on rank 0. Collective.
  OpenBatch(Communicator& communicator, const Command& command, const std::filesystem::path& input) {
    communicator.run_collectively([&] {
      if (!communicator.is_root()) return;
      reader.emplace(input, row_kind(command));
      if (reader->has_ids()) BatchReader(input, row_kind(command)).require_unique_ids();
      backend = framework::choose_backend(command.backend, useful_threads(command, input));
      outputs.emplace(command);
    });
    MessageWriter writer;
    writer.put(backend);
    writer.put_all(reader ? reader->columns() : std::vector<int>());
    const std::string message = communicator.broadcast(writer.take());
    MessageReader facts(message);
    backend = facts.get<device::Backend>();
    columns = facts.get_all<int>();
  }

  std::optional<BatchReader> reader;
  std::optional<OutputFiles> outputs;
  device::Backend backend{};  ///< the same on all ranks, since bits may differ between backends
  std::vector<int> columns;   ///< as `BatchReader::columns`
};

/// Settings of this rank, with its share of the host's cores.
options::Settings rank_settings(options::Settings settings, const Communicator& communicator) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  settings.host_threads = std::max(1, cores / communicator.ranks_on_host());
  return settings;
}

/// One batch and its result document.
class BatchRun {
 public:
  BatchRun(Communicator& communicator, const Command& command, const std::filesystem::path& input)
      : _communicator(communicator),
        _command(command),
        _input(input),
        _result(run::new_result("drogue-options", input.stem().string())) {
    _result.metrics.add_group("counts");
    framework::set_no_limiter(_result.metrics);
    _result.ranks = communicator.size();
  }

  ExitCode run() {
    try {
      _result.exit_code = execute();
    } catch (...) {
      const Failure failure = current_failure();
      run::record_failure(_result, failure, [this] { write_result(); });
      throw failure;
    }
    write_result();
    return _result.exit_code;
  }

 private:
  /// Returns `ok` or `interrupted`. All files are closed at the return, so that a full disk has room for the
  /// result.
  ExitCode execute() {
    OpenBatch batch(_communicator, _command, _input);
    std::optional<framework::DeviceSession> session;
    std::unique_ptr<options::Pricer> pricer;
    std::optional<options::SensitivityPricer> sensitivities;
    _communicator.run_collectively([&] {
      framework::require_backend(batch.backend);
      session.emplace(batch.backend, _command.kokkos);
      session->describe(_result);
      if (_communicator.is_root() && !_command.quiet) session->print_shared_cores("drogue-options");
      const options::Settings settings = rank_settings(_command.settings, _communicator);
      pricer = with_usage_error([&] { return options::create_pricer(batch.backend, settings); });
      if (settings.greeks) sensitivities.emplace(batch.backend, settings);
    });
    _result.timing.setup_s = _wall_time.seconds();
    const Stopwatch run_time;
    ChunkPricer chunk_pricer(_command, row_kind(_command), batch.columns, *pricer,
                             sensitivities ? &*sensitivities : nullptr);
    PricingResult priced;
    _communicator.run_collectively([&] {
      if (!_communicator.is_root()) return run_worker(_communicator, chunk_pricer);
      priced = price_on_all_ranks(_communicator, _command, *batch.reader, *batch.outputs, chunk_pricer);
      if (priced.is_complete) batch.outputs->commit();
    });
    if (!_communicator.is_root()) return ExitCode::ok;
    describe(priced.usage, run_time.seconds());
    return conclude(priced.is_complete, batch);
  }

  void describe(const WorkerUsage& usage, double seconds) {
    run::ResultDocument::WallTimes& timing = _result.timing;
    timing.h2d_s = usage.wall_times.h2d / _result.ranks;
    timing.compute_s = usage.wall_times.compute / _result.ranks;
    timing.d2h_s = usage.wall_times.d2h / _result.ranks;
    timing.io_s = std::max(0.0, seconds - (timing.h2d_s + timing.compute_s + timing.d2h_s));
    _result.timing.wall_s = _wall_time.seconds();
    _result.describe_ledger(usage.counters);
  }

  /// Describes the rows in the result and on standard output. Throws `Failure` for invalid or failed rows.
  ExitCode conclude(bool is_complete, const OpenBatch& batch) {
    const RowCounts& counts = batch.outputs->counts();
    describe_counts(counts, _result);
    if (!is_complete) {
      const std::string written = run::is_replaced(_command.out) ? "nothing" : "not all";
      _result.message =
          "interrupted by a signal; " + written + " is written to '" + _command.out.string() + "'";
      print_notice("drogue-options", _result.message);
      return ExitCode::interrupted;
    }
    if (!_command.quiet && !writes_to_standard_output())
      print_summary(_command, _result, counts, batch.reader->rows());
    require_all_priced(_command, counts, *batch.reader);
    return ExitCode::ok;
  }

  /// True if a summary on standard output would mix with rows.
  [[nodiscard]] bool writes_to_standard_output() const {
    for (const std::filesystem::path* path : {&_command.out, &_command.result, &_command.boundary})
      if (run::is_same_file(*path, "/proc/self/fd/1")) return true;
    return false;
  }

  void write_result() const {
    if (_communicator.is_root() && !_command.result.empty()) run::write_result(_command.result, _result);
  }

  Communicator& _communicator;
  const Command& _command;
  const std::filesystem::path& _input;
  const Stopwatch _wall_time;
  run::ResultDocument _result;
};

}  // namespace

ExitCode run_batch(Communicator& communicator, const Command& command) {
  std::filesystem::path input;
  communicator.run_collectively([&] {
    if (!communicator.is_root()) return;
    input = find_batch(command.input);
    check_outputs(command, input);
  });
  return BatchRun(communicator, command, input).run();
}

}  // namespace drogue::options_app
