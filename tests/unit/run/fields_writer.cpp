#include "common/run/fields/fields_writer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "common/run/files/atomic_file.hpp"
#include "common/run/hdf5/hdf5.hpp"
#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using test::content;
using test::failure_of;
using test::TemporaryDirectory;

constexpr std::uint64_t cells = 1000;

std::vector<DatasetSpec> gas_fields(std::uint64_t n = cells) {
  return {{"rho", {n}, "kg/m^3", "cell", "density"}, {"u", {n}, "m/s", "cell", "velocity"}};
}

void add_line(FieldsWriter& fields, std::uint64_t n = cells) {
  fields.add_mesh({"x", {n}, "m", "cell", "cell centres"}, [](std::uint64_t first, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5 * static_cast<double>(first + i);
  });
}

/// Values that are unique within a step, so that a misplaced piece is detected.
std::vector<double> field_values(double time, double offset, std::uint64_t n = cells) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = 1000.0 * time + offset + 1e-4 * static_cast<double>(i);
  return values;
}

void write_step(FieldsWriter& fields, double time, std::uint64_t n = cells) {
  fields.begin_step(time, std::lround(10 * time));
  for (const double offset : {0.0, 1.0})
    fields.write(offset == 0.0 ? "rho" : "u", 0, field_values(time, offset, n));
  fields.end_step();
}

std::vector<double> read_back(const std::filesystem::path& file, const std::string& dataset) {
  const h5::Handle handle = h5::open_file(file, false);
  const h5::Handle data = h5::open_dataset(handle, dataset);
  std::vector<double> values(h5::shape(data).at(0));
  h5::read(data, 0, values);
  return values;
}

std::vector<std::string> step_groups(const std::filesystem::path& file) {
  const h5::Handle handle = h5::open_file(file, false);
  return h5::children(h5::open_group(handle, "steps"));
}

TEST(FieldsWriter, WritesTheDocumentedLayout) {
  const TemporaryDirectory directory;
  FieldsWriter fields(directory.path(), "sod", gas_fields());
  add_line(fields);
  write_step(fields, 0.2);
  write_step(fields, 0.4);
  const std::filesystem::path file = directory / "fields.h5";
  EXPECT_EQ(fields.steps(), 2U);
  EXPECT_EQ(step_groups(file), (std::vector<std::string>{"000000", "000001"}));
  EXPECT_EQ(read_back(file, "steps/000001/u"), field_values(0.4, 1.0));
  EXPECT_EQ(read_back(file, "mesh/x").at(999), 499.5);

  const h5::Handle handle = h5::open_file(file, false);
  const h5::Handle step = h5::open_group(handle, "steps/000001");
  EXPECT_EQ(h5::read_number(step, "time"), 0.4);
  EXPECT_EQ(h5::read_integer(step, "step"), 4);
  for (const std::string name : {"mesh/x", "steps/000000/rho"}) {
    const h5::Handle dataset = h5::open_dataset(handle, name);
    EXPECT_EQ(h5::read_text(dataset, "units"), name == "mesh/x" ? "m" : "kg/m^3");
    EXPECT_EQ(h5::read_text(dataset, "centering"), "cell");
    EXPECT_EQ(h5::read_text(dataset, "description"), name == "mesh/x" ? "cell centres" : "density");
  }
}

TEST(FieldsWriter, AcceptsPiecesInAnyOrder) {
  const TemporaryDirectory directory;
  FieldsWriter fields(directory.path(), "sod", gas_fields());
  const std::vector<double> values = field_values(1.0, 0.0);
  fields.begin_step(1.0, 10);
  fields.write("rho", 600, std::span(values).subspan(600));
  fields.write("rho", 0, std::span(values).first(600));
  fields.end_step();
  EXPECT_EQ(read_back(directory / "fields.h5", "steps/000000/rho"), values);
}

TEST(FieldsWriter, WritesRowsOfVectorsAndIntegers) {
  const TemporaryDirectory directory;
  FieldsWriter fields(directory.path(), "cloth", {{"position", {4, 3}, "m", "vertex", "position"}});
  fields.add_mesh({"triangles", {2, 3}, "1", "cell", "vertices"},
                  IntegerSource([](std::uint64_t first, std::span<std::int64_t> values) {
                    for (std::size_t i = 0; i < values.size(); ++i)
                      values[i] = static_cast<std::int64_t>(first + i);
                  }));
  const std::vector<double> two_rows = {6, 7, 8, 9, 10, 11};
  fields.begin_step(0.0, 0);
  fields.write("position", 6, two_rows);
  const std::string sentence =
      failure_of(ExitCode::io_error, [&] { fields.write("position", 4, std::span(two_rows).first(3)); });
  EXPECT_NE(sentence.find("whole rows"), std::string::npos) << sentence;

  fields.begin_step(0.0, 0);
  fields.write("position", 6, two_rows);
  fields.end_step();
  const h5::Handle handle = h5::open_file(directory / "fields.h5", false);
  std::vector<double> triangles(6);
  h5::read(h5::open_dataset(handle, "mesh/triangles"), 0, triangles);
  EXPECT_EQ(triangles, (std::vector<double>{0, 1, 2, 3, 4, 5}));
  std::vector<double> row(3);
  h5::read(h5::open_dataset(handle, "steps/000000/position"), 9, row);
  EXPECT_EQ(row, (std::vector<double>{9, 10, 11}));
}

// ctest-label: no-sanitizer
TEST(FieldsWriter, LosesNothingIfKilledBetweenSteps) {
  const TemporaryDirectory directory;
  const int status = test::in_child([&directory] {
    FieldsWriter fields(directory.path(), "sod", gas_fields());
    add_line(fields);
    write_step(fields, 0.2);
    write_step(fields, 0.4);
    return raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(step_groups(directory / "fields.h5").size(), 2U);
  EXPECT_EQ(read_back(directory / "fields.h5", "steps/000001/rho"), field_values(0.4, 0.0));
}

// Enough groups and data that HDF5 would by default write some metadata within the step.
// ctest-label: no-sanitizer
TEST(FieldsWriter, KeepsFormerStepsIfKilledWithinAStep) {
  const TemporaryDirectory directory;
  std::vector<DatasetSpec> many;
  for (int i = 0; i < 3000; ++i)
    many.push_back({"f" + std::to_string(i), {8}, "1", "cell", std::string(500, 'd')});
  const std::vector<double> values(8, 7.0);
  const int status = test::in_child([&] {
    FieldsWriter fields(directory.path(), "many", many);
    fields.begin_step(0.0, 0);
    for (const DatasetSpec& spec : many) fields.write(spec.name, 0, values);
    fields.end_step();
    fields.begin_step(1.0, 1);
    for (const DatasetSpec& spec : many) fields.write(spec.name, 0, values);
    return raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(step_groups(directory / "fields.h5"), std::vector<std::string>{"000000"});
  EXPECT_EQ(read_back(directory / "fields.h5", "steps/000000/f2999"), values);
  FieldsWriter resumed(directory.path(), "many", many, 0.0);
  resumed.begin_step(1.0, 1);
  resumed.end_step();
  EXPECT_EQ(step_groups(directory / "fields.h5").size(), 2U);
}

// ctest-label: no-sanitizer
TEST(FieldsWriter, LeavesAReadableFileIfKilledAtAnyMoment) {
  for (int round = 0; round < 10; ++round) {
    const TemporaryDirectory directory;
    const pid_t child = fork();
    if (child == 0) {
      FieldsWriter fields(directory.path(), "sod", gas_fields());
      add_line(fields);
      for (int step = 0;; ++step) write_step(fields, step);
    }
    const std::filesystem::path listing = directory / "fields.xdmf";
    while (!std::filesystem::exists(listing)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::microseconds(7000 + 1370 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::filesystem::path file = directory / "fields.h5";
    const std::vector<std::string> groups = step_groups(file);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      EXPECT_EQ(read_back(file, "steps/" + groups[i] + "/u"), field_values(static_cast<double>(i), 1.0));
    }
  }
}

TEST(FieldsWriter, KeepsFormerStepsOnAFullDisk) {
  const TemporaryDirectory directory;
  constexpr std::uint64_t large = 20000;
  const int status = test::in_child([&directory] {
    test::limit_file_size(800'000);
    FieldsWriter fields(directory.path(), "sod", gas_fields(large));
    add_line(fields, large);
    write_step(fields, 0.0, large);
    const std::string sentence =
        failure_of(ExitCode::io_error, [&fields] { write_step(fields, 1.0, large); });
    return sentence.find("fields.h5': File too large") != std::string::npos && fields.steps() == 1 ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_EQ(step_groups(directory / "fields.h5"), std::vector<std::string>{"000000"});
  EXPECT_EQ(read_back(directory / "fields.h5", "steps/000000/u"), field_values(0.0, 1.0, large));
}

TEST(FieldsWriter, ContinuesWithoutLaterStepsAfterARestart) {
  const TemporaryDirectory directory;
  {
    FieldsWriter fields(directory.path(), "sod", gas_fields());
    add_line(fields);
    for (const double time : {0.0, 1.0, 2.0}) write_step(fields, time);
  }
  FieldsWriter fields(directory.path(), "sod", gas_fields(), 1.0);
  add_line(fields);
  EXPECT_EQ(fields.steps(), 2U);
  write_step(fields, 1.5);
  EXPECT_EQ(read_back(directory / "fields.h5", "steps/000001/rho"), field_values(1.0, 0.0));
  EXPECT_EQ(read_back(directory / "fields.h5", "steps/000002/rho"), field_values(1.5, 0.0));
  EXPECT_EQ(step_groups(directory / "fields.h5").size(), 3U);
  EXPECT_EQ(content(directory / "fields.xdmf").find("Time Value=\"2\""), std::string::npos);
}

TEST(FieldsWriter, HoldsMoreStepsThanOneIndexPage) {
  const TemporaryDirectory directory;
  constexpr std::uint64_t few = 2;
  const auto wanted = [](std::size_t i) { return field_values(static_cast<double>(i), 1.0, few); };
  FieldsWriter fields(directory.path(), "sod", gas_fields(few));
  for (int i = 0; i < 600; ++i) write_step(fields, i, few);
  FieldsWriter resumed(directory.path(), "sod", gas_fields(few), 549.0);
  EXPECT_EQ(resumed.steps(), 550U);
  for (int i = 550; i < 560; ++i) write_step(resumed, i, few);
  const h5::Handle handle = h5::open_file(directory / "fields.h5", false);
  const h5::Handle steps = h5::open_group(handle, "steps");
  const std::vector<std::string> names = h5::children(steps);
  ASSERT_EQ(names.size(), 560U);
  std::vector<double> values(few);
  for (std::size_t i = 0; i < names.size(); ++i) {
    h5::read(h5::open_dataset(h5::open_group(steps, names[i]), "u"), 0, values);
    EXPECT_EQ(values, wanted(i));
  }
}

TEST(FieldsWriter, WritesWhileAReaderHasTheFileOpen) {
  const TemporaryDirectory directory;
  FieldsWriter fields(directory.path(), "sod", gas_fields());
  write_step(fields, 0.0);
  const int reader = open((directory / "fields.h5").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(reader, LOCK_SH), 0) << "what HDF5 does in a viewer";
  EXPECT_NO_THROW(write_step(fields, 1.0));
  close(reader);
  EXPECT_EQ(step_groups(directory / "fields.h5").size(), 2U);
}

TEST(FieldsWriter, RefusesToContinueADamagedFile) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "fields.h5", "this is no HDF5");
  const std::string sentence = failure_of(ExitCode::io_error, [&directory] {
    const FieldsWriter fields(directory.path(), "sod", gas_fields(), 1.0);
  });
  EXPECT_NE(sentence.find("cannot open '" + (directory / "fields.h5").string()), std::string::npos)
      << sentence;
}

TEST(FieldsWriter, KeepsSeveralGridsInOneFile) {
  const TemporaryDirectory directory;
  const std::vector<DatasetSpec> specs = {{"pressure", {2, 3, 4}, "Pa", "cell", "pressure"},
                                          {"position", {3, 3}, "m", "vertex", "positions", "canopy"}};
  const auto zeros = [](std::uint64_t, std::span<double> values) { std::ranges::fill(values, 0.0); };
  const auto corners = [](std::uint64_t first, std::span<std::int64_t> values) {
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<std::int64_t>(first + k);
  };
  const auto write = [&](std::optional<double> resume_time, double time) {
    FieldsWriter fields(directory.path(), "drop", specs, resume_time);
    fields.add_mesh({"triangles", {1, 3}, "1", "face", "", "canopy"}, IntegerSource(corners));
    fields.add_mesh({"strings", {0, 2}, "1", "edge", "", "canopy"}, IntegerSource(corners));
    fields.add_mesh({"vertices", {3, 3}, "m", "vertex", "", "canopy"}, Source(zeros));
    // A grid at rest, without fields.
    fields.add_mesh({"triangles", {1, 3}, "1", "face", "", "body"}, IntegerSource(corners));
    fields.add_mesh({"strings", {0, 2}, "1", "edge", "", "body"}, IntegerSource(corners));
    fields.add_mesh({"vertices", {3, 3}, "m", "vertex", "", "body"}, Source(zeros));
    EXPECT_EQ(std::filesystem::exists(directory / "fields.xdmf"), resume_time.has_value());
    for (const auto& [name, faces] : {std::pair{"x", 5U}, std::pair{"y", 4U}, std::pair{"z", 3U}})
      fields.add_mesh({name, {faces}, "m", "face", ""}, Source(zeros));
    fields.begin_step(time, 1);
    fields.write("pressure", 0, std::vector<double>(24, time));
    fields.write("canopy/position", 0, std::vector<double>(9, 2.0 * time));
    fields.end_step();
  };
  write({}, 1.0);
  write(1.0, 2.0);
  EXPECT_EQ(step_groups(directory / "fields.h5"), (std::vector<std::string>{"000000", "000001"}));
  const h5::Handle handle = h5::open_file(directory / "fields.h5", false);
  EXPECT_EQ(h5::shape(h5::open_dataset(handle, "mesh/canopy/triangles")), (std::vector<std::uint64_t>{1, 3}));
  std::vector<double> values(9);
  h5::read(h5::open_dataset(handle, "steps/000001/canopy/position"), 0, values);
  EXPECT_EQ(values, std::vector<double>(9, 4.0));
  const std::string xdmf = content(directory / "fields.xdmf");
  EXPECT_NE(xdmf.find("fields.h5:/steps/000001/canopy/position"), std::string::npos) << xdmf;
  EXPECT_NE(xdmf.find("fields.h5:/mesh/body/vertices"), std::string::npos) << xdmf;
  EXPECT_NE(xdmf.find("Dimensions=\"3 4 5\""), std::string::npos) << xdmf;
}

}  // namespace
}  // namespace drogue::run
