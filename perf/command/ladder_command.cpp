#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <memory>

#include "common/program/command_line.hpp"
#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/statistics.hpp"
#include "perf/command/command.hpp"
#include "perf/ladders/exercises/exercises.hpp"
#include "perf/ladders/ladder.hpp"
#include "perf/measure/record.hpp"
#include "perf/rows/printed.hpp"
#include "perf/rows/rows.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

struct LadderOptions {
  std::string ladder, out;
  std::string backend = "auto";
  bool quick = false, explain = false, solutions = false;
};

std::string text(device::Backend backend) { return std::string(device::name(backend)); }

/// Case of a rung; a sample is a run from the initial state.
Case case_of(const ladder::Ladder& ladder, const ladder::Rung& rung, device::Backend backend) {
  return {.name = "ladder/" + ladder.name + "/" + text(backend) + "/" + std::to_string(ladder.size) + "/" +
                  rung.text.name,
          .backend = backend,
          .unit_of_work = ladder.unit,
          .bound = rung.text.idea,
          .tolerance = rung.tolerance,
          .prepare = [make = rung.make, units = ladder.units] {
            const std::shared_ptr<ladder::RungRun> run = make();
            return Sample{[=] { run->reset(); },
                          [=] {
                            run->run();
                            return units;
                          },
                          [=] { return run->error(); }};
          }};
}

nlohmann::json facts_of(const ladder::Ladder& ladder, const ladder::Rung& rung,
                        const ladder::Prediction& predicted, device::Backend backend) {
  return {{"backend", device::name(backend)},
          {"cells", ladder.size},
          {"ladder", ladder.name},
          {"rung", rung.text.name},
          {"predicted_s", predicted.seconds},
          {"predicted_bound", predicted.bound},
          {"flops", rung.work.flops},
          {"bytes", rung.work.bytes}};
}

void print_ceilings(const ladder::Ceilings& c) {
  std::printf(
      "measured: launch %.3g us; copy %.3g us and %.3g GB/s pageable, %.3g pinned; memory %.3g GB/s; "
      "%.3g GFLOP/s and %.3g G divisions/s, on %d lane%s; %.3g G divisions/s without packs\n\n",
      1e6 * c.launch, 1e6 * c.copy, 1e-9 * c.pageable, 1e-9 * c.pinned, 1e-9 * c.bandwidth, 1e-9 * c.flops,
      1e-9 * c.divisions, c.lanes, c.lanes == 1 ? "" : "s", 1e-9 * c.scalar_divisions);
}

/// Prints the predictions, before any rung is timed: a reader can compare them with his own.
std::vector<ladder::Prediction> print_predictions(const ladder::Ladder& ladder,
                                                  const ladder::Ceilings& ceilings) {
  std::printf("predicted, us per %s:\n", ladder.unit.c_str());
  std::vector<ladder::Prediction> predictions;
  for (const ladder::Rung& rung : ladder.rungs) {
    predictions.push_back(ladder::predict(rung.work, ceilings));
    if (rung.available)
      std::printf("  %-18s %12.2f  by %s\n", rung.text.name, 1e6 * predictions.back().seconds,
                  predictions.back().bound);
    else
      std::printf("  %-18s %12s\n", rung.text.name, "GPU only");
  }
  std::printf("\n");
  std::fflush(stdout);
  return predictions;
}

/// Predictions precede the measurement: they come from the work of a rung and the ceilings alone.
ExitCode climb(const LadderOptions& options, device::Backend backend) {
  const nlohmann::json here = provenance(device::device_facts());
  const ladder::Ladder ladder = ladder::create_ladder(options.ladder, backend, options.quick);
  std::printf("%s, %s: %lld, %ld %s%s a run, on %s\n", ladder.name.c_str(), ladder.problem.c_str(),
              static_cast<long long>(ladder.size), ladder.units, ladder.unit.c_str(),
              ladder.units == 1 ? "" : "s", text(backend).c_str());
  const ladder::Ceilings ceilings = ladder::measure_ceilings(backend);
  print_ceilings(ceilings);
  const std::vector<ladder::Prediction> predictions = print_predictions(ladder, ceilings);
  std::vector<Case> cases;
  for (const ladder::Rung& rung : ladder.rungs)
    if (rung.available) cases.push_back(case_of(ladder, rung, backend));
  const std::vector<Record> records =
      measure(cases, warm_up_rounds, kept_rounds(options.quick), {&device_clocks()});

  std::printf("%-18s %12s  %-10s %12s  %-22s %9s %9s  %9s\n", "rung", "predicted", "by", "measured",
              ("us per " + ladder.unit + ", 95 %").c_str(), "to first", "to last", "error");
  Table table;
  double first = 0.0, last = 0.0;
  auto record = records.begin();
  for (std::size_t k = 0; k < ladder.rungs.size(); ++k) {
    const ladder::Rung& rung = ladder.rungs[k];
    if (!rung.available) continue;
    const Record& measured = *record++;
    table.add(measured, here, facts_of(ladder, rung, predictions[k], backend));
    std::printf("%-18s %12.2f  %-10s ", rung.text.name, 1e6 * predictions[k].seconds, predictions[k].bound);
    // A wrong result has no time.
    if (measured.passed()) {
      const double time = run::median(measured.samples);
      if (first == 0.0) first = last = time;
      std::printf("%12.2f  %-22s %8.2fx %8.2fx", 1e6 * time, interval_text(measured, 1e6, 2).c_str(),
                  first / time, last / time);
      last = time;
    } else {
      std::printf("%12s  %-22s %9s %9s", "", "", "", "");
    }
    std::printf("  %9.2g  %s\n", measured.error, verdict(measured));
  }
  if (options.explain) {
    std::printf("\nHindsights on hosts are those of an Intel Xeon with AVX-512: docs/lessons/tables.md\n");
    for (const ladder::Rung& rung : ladder.rungs)
      std::printf("\n%s: %s\n  %s\n", rung.text.name, rung.text.idea, rung.text.hindsight);
  }
  write_records(options.out, table.records);
  return code_of(table.passed);
}

/// State of an exercise after its run, in words, with the task unless it is done.
struct Checked {
  bool done;
  std::string words;
};

Checked check(const ladder::Exercise& exercise, double error) {
  if (error > exercise.rung.tolerance) return {false, "broken: " + std::string(exercise.task)};
  if (exercise.factor == 0.0) return {true, "mended"};
  const double factor = ladder::speed_up_of(exercise);
  const bool done = factor >= exercise.factor;
  return {done, printed("%s: %.2f times as fast (goal %.3g)%s%s", done ? "fast" : "slow", factor,
                        exercise.factor, done ? "" : ". ", done ? "" : exercise.task)};
}

/// Runs the exercises. Throws Failure(verification_failed) unless all are done.
ExitCode check_exercises(device::Backend backend, ladder::ExerciseCode code) {
  std::printf("%-12s %-40s %9s %9s\n", "exercise", "file", "error", "tolerance");
  struct Count {
    int all = 0, open = 0;
  } mend, speed;
  for (const ladder::Exercise& exercise : ladder::create_exercises(backend, code)) {
    const double error = ladder::error_of(exercise);
    const Checked checked = check(exercise, error);
    Count& count = exercise.factor == 0.0 ? mend : speed;
    ++count.all, count.open += checked.done ? 0 : 1;
    std::printf("%-12s %-40s %9.2g %9.2g  %s\n", exercise.name, exercise.file, error, exercise.rung.tolerance,
                checked.words.c_str());
    std::fflush(stdout);
  }
  if (mend.open + speed.open > 0)
    throw Failure(ExitCode::verification_failed,
                  std::to_string(mend.open) + " of " + std::to_string(mend.all) + " exercises are broken, " +
                      std::to_string(speed.open) + " of " + std::to_string(speed.all) +
                      " slow ones not fast enough: edit their files, build drogue-perf and check again");
  return ExitCode::ok;
}

}  // namespace

Command ladder_command(CLI::App& program) {
  const auto options = std::make_shared<LadderOptions>();
  CLI::App* app = program.add_subcommand(
      "ladder", "Climb a ladder of versions of one kernel: predicted and measured times, errors");
  app->add_option("LADDER", options->ladder, "weno, springs, options or transfers; check: the exercises")
      ->required();
  app->add_option("--backend", options->backend, "Where to measure: auto takes the fastest present")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app->add_option("--out", options->out, "File for the records, one JSON line a rung");
  app->add_flag("--quick", options->quick, "Small problem and few samples");
  app->add_flag("--solutions", options->solutions,
                "Run the solutions instead of the files to edit (check alone)");
  app->add_flag("--explain", options->explain, "Print the idea of each rung and what its prediction missed");
  return {app, [options](const std::vector<std::string>& kokkos) {
            std::vector<std::string> valid = ladder::names();
            valid.push_back("check");
            require_name("ladder", options->ladder, valid);
            if (options->ladder == "check" && (!options->out.empty() || options->quick || options->explain))
              throw Failure(ExitCode::usage, "ladder check has the options --backend and --solutions alone");
            if (options->ladder != "check" && options->solutions)
              throw Failure(ExitCode::usage, "--solutions is an option of ladder check");
            run::require_writable(options->out);
            const device::Backend backend = device::wanted_backend(options->backend);
            require(backend);
            const device::Runtime runtime(kokkos);
            install_signal_handlers();
            if (options->ladder != "check") return climb(*options, backend);
            return check_exercises(
                backend, options->solutions ? ladder::ExerciseCode::solution : ladder::ExerciseCode::own);
          }};
}

}  // namespace drogue::perf
