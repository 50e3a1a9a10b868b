// ctest-label: no-sanitizer
// Kills a writer of fields.h5 at every system call that changes a file. This executable wraps those calls. A
// write also has a kill point at the end of each page, where the system may stop a write of a killed process.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/run/fields/fields_writer.hpp"
#include "common/run/hdf5/hdf5.hpp"
#include "tests/unit/run/temporary_directory.hpp"

namespace {

constexpr long never = -1;
long moments_left = never;  ///< kill points before the process is killed

/// Atomic unit of a write, bytes.
std::size_t page = drogue::run::h5::index_page;

void moment() {
  if (moments_left == 0) kill(getpid(), SIGKILL);
  if (moments_left != never) --moments_left;
}

/// Executes `call(data, bytes, offset)` page by page.
template <typename Call>
ssize_t in_pages(const void* data, std::size_t size, off_t offset, const Call& call) {
  std::size_t done = 0;
  do {
    const std::size_t at = static_cast<std::size_t>(offset) + done;
    moment();
    const long written =
        call(static_cast<const char*>(data) + done, std::min(size - done, page - at % page), at);
    if (written < 0) return written;
    done += static_cast<std::size_t>(written);
  } while (done < size);
  return static_cast<ssize_t>(done);
}

}  // namespace

// Wrappers of all calls by which HDF5 and this library change files.
extern "C" {

ssize_t pwrite(int file, const void* data, std::size_t size, off_t offset) {
  return in_pages(data, size, offset, [file](const char* piece, std::size_t bytes, std::size_t at) {
    return syscall(SYS_pwrite64, file, piece, bytes, at);
  });
}

ssize_t write(int file, const void* data, std::size_t size) {
  return in_pages(data, size, 0, [file](const char* piece, std::size_t bytes, std::size_t) {
    return syscall(SYS_write, file, piece, bytes);
  });
}

int ftruncate(int file, off_t length) noexcept {
  moment();
  return static_cast<int>(syscall(SYS_ftruncate, file, length));
}

int fallocate(int file, int mode, off_t offset, off_t length) {
  moment();
  return static_cast<int>(syscall(SYS_fallocate, file, mode, offset, length));
}

int rename(const char* from, const char* to) noexcept {
  moment();
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0U));
}

}  // extern "C"

namespace drogue::run {
namespace {

using test::TemporaryDirectory;
using Times = std::vector<double>;

std::uint64_t cells = 700;  ///< two or three pages a field

std::vector<double> values_of(double time, const std::string& field) {
  std::vector<double> values(cells);
  for (std::size_t i = 0; i < cells; ++i)
    values[i] = 1000.0 * time + (field == "u" ? 0.5 : 0.0) + 1e-4 * static_cast<double>(i);
  return values;
}

/// Writer of a run with its mesh.
struct SodRun {
  explicit SodRun(const std::filesystem::path& directory, std::optional<double> resume_time = std::nullopt)
      : fields(directory, "sod",
               {{"rho", {cells}, "kg/m^3", "cell", "density"}, {"u", {cells}, "m/s", "cell", "velocity"}},
               resume_time) {
    fields.add_mesh({"x", {cells}, "m", "cell", "cell centres"}, [](std::uint64_t, std::span<double> values) {
      std::ranges::copy(values_of(0.0, "x"), values.begin());
    });
    fields.add_mesh(
        {"id", {cells}, "1", "cell", "numbers"},
        IntegerSource([](std::uint64_t, std::span<std::int64_t> values) { std::ranges::fill(values, 7); }));
  }

  void step(double time) {
    fields.begin_step(time, std::lround(10.0 * time));
    for (const std::string name : {"rho", "u"}) fields.write(name, 0, values_of(time, name));
    fields.end_step();
  }

  FieldsWriter fields;
};

void expect_dataset(const h5::Handle& parent, const std::string& name, const std::vector<double>& wanted,
                    const std::string& units) {
  const h5::Handle dataset = h5::open_dataset(parent, name);
  std::vector<double> values(h5::shape(dataset).at(0));
  h5::read(dataset, 0, values);
  EXPECT_EQ(values, wanted) << name;
  EXPECT_EQ(h5::read_text(dataset, "units"), units);
  EXPECT_EQ(h5::read_text(dataset, "centering"), "cell");
  EXPECT_FALSE(h5::read_text(dataset, "description").empty());
}

/// Times of the steps in the file, which must all be complete.
Times whole_steps(const std::filesystem::path& file) {
  const h5::Handle handle = h5::open_file(file, false);
  std::vector<std::string> groups = h5::children(handle);
  if (std::erase(groups, "reference") > 0) {
    const h5::Handle reference = h5::open_group(handle, "reference");
    EXPECT_EQ(h5::children(reference), (std::vector<std::string>{"rho", "x"}));
    expect_dataset(reference, "rho", values_of(2.0, "rho"), "kg/m^3");
  }
  EXPECT_EQ(groups, (std::vector<std::string>{"mesh", "steps"}));
  const h5::Handle mesh = h5::open_group(handle, "mesh");
  for (const std::string& name : h5::children(mesh)) {
    if (name == "x") expect_dataset(mesh, name, values_of(0.0, "x"), "m");
    if (name == "id") expect_dataset(mesh, name, std::vector<double>(cells, 7.0), "1");
  }
  Times times;
  const h5::Handle steps = h5::open_group(handle, "steps");
  const std::vector<std::string> names = h5::children(steps);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string digits = std::to_string(i);
    EXPECT_EQ(names[i], std::string(6 - digits.size(), '0') + digits);
    const h5::Handle step = h5::open_group(steps, names[i]);
    times.push_back(h5::read_number(step, "time"));
    if (i >= 3 && i + 3 < names.size()) continue;  // keeps the test short
    EXPECT_EQ(h5::read_integer(step, "step"), std::lround(10.0 * times.back()));
    EXPECT_EQ(h5::children(step), (std::vector<std::string>{"rho", "u"}));
    expect_dataset(step, "rho", values_of(times.back(), "rho"), "kg/m^3");
    expect_dataset(step, "u", values_of(times.back(), "u"), "m/s");
  }
  return times;
}

/// Repeats `work` after `preparation`, each time killed `stride` kill points later, until it completes. The
/// steps that a kill leaves must be one of `stages`, never an earlier one than a former kill left, and the
/// file must be continuable. Returns the number of kill points.
long kill_everywhere(const std::function<void(const std::filesystem::path&)>& preparation,
                     const std::function<void(const std::filesystem::path&)>& work,
                     const std::vector<Times>& stages, long stride = 1) {
  const TemporaryDirectory prepared;
  preparation(prepared.path());
  std::size_t stage = 0;
  for (long passed = 0; passed < 10'000; passed += stride) {
    const TemporaryDirectory directory;
    std::filesystem::copy(prepared.path(), directory.path());
    const int status = test::in_child([&] {
      moments_left = passed;
      work(directory.path());
      return 0;
    });
    SCOPED_TRACE("killed before moment " + std::to_string(passed));
    const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    EXPECT_TRUE(ended || (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)) << status;
    const std::filesystem::path file = directory / "fields.h5";
    Times times;
    try {
      if (std::filesystem::exists(file)) times = whole_steps(file);
      while (stage < stages.size() && stages[stage] != times) ++stage;
      SodRun continued(directory.path(), 1e9);
      continued.step(100.0);
      times.push_back(100.0);
      EXPECT_EQ(whole_steps(file), times);
    } catch (const Failure& failure) {
      ADD_FAILURE() << failure.what();
    }
    if (stage == stages.size())
      ADD_FAILURE() << "no stage, or an earlier one: " << ::testing::PrintToString(times);
    if (ended) {
      EXPECT_EQ(stage + 1, stages.size());
    }
    if (ended || ::testing::Test::HasFailure()) return passed;
  }
  ADD_FAILURE() << "it does not end";
  return 0;
}

void nothing(const std::filesystem::path&) {}

TEST(FieldsWriterKilled, FileStaysReadableWhileItIsCreated) {
  const auto work = [](const std::filesystem::path& directory) {
    SodRun run(directory);
    for (const double time : {0.0, 1.0, 2.0}) run.step(time);
  };
  EXPECT_GT(kill_everywhere(nothing, work, {{}, {0.0}, {0.0, 1.0}, {0.0, 1.0, 2.0}}), 60);
}

TEST(FieldsWriterKilled, FileStaysReadableWhileLaterStepsAreDropped) {
  const auto preparation = [](const std::filesystem::path& directory) {
    SodRun run(directory);
    for (const double time : {0.0, 1.0, 2.0, 3.0}) run.step(time);
  };
  const auto work = [](const std::filesystem::path& directory) { SodRun(directory, 1.0).step(1.5); };
  EXPECT_GT(kill_everywhere(preparation, work, {{0.0, 1.0, 2.0, 3.0}, {0.0, 1.0}, {0.0, 1.0, 1.5}}), 20);
}

TEST(FieldsWriterKilled, FileStaysReadableAfterAFailedStep) {
  const auto work = [](const std::filesystem::path& directory) {
    SodRun run(directory);
    run.step(0.0);
    run.fields.begin_step(1.0, 10);
    run.fields.write("rho", 0, values_of(1.0, "rho"));
    EXPECT_THROW(run.fields.write("rho", 1, values_of(1.0, "rho")), Failure) << "one value too many";
    run.step(2.0);
  };
  EXPECT_GT(kill_everywhere(nothing, work, {{}, {0.0}, {0.0, 2.0}}), 50);
}

TEST(FieldsWriterKilled, FileStaysReadableWhileAReferenceIsWritten) {
  const auto work = [](const std::filesystem::path& directory) {
    SodRun run(directory);
    run.step(0.0);
    const std::vector<double> x = values_of(0.0, "x"), rho = values_of(2.0, "rho");
    for (int i = 0; i < 2; ++i)
      run.fields.add_reference({"z",
                                {{{"x", {cells}, "m", "cell", "cell centres"}, x},
                                 {{"rho", {cells}, "kg/m^3", "cell", "density"}, rho}}});
    run.step(1.0);
  };
  EXPECT_GT(kill_everywhere(nothing, work, {{}, {0.0}, {0.0, 1.0}}), 60);
}

// The 191st output moves the index into a block of more than one page.
TEST(FieldsWriterKilled, FileStaysReadableWhileTheIndexGrows) {
  cells = 2;
  const auto preparation = [](const std::filesystem::path& directory) {
    SodRun run(directory);
    for (int i = 0; i < 190; ++i) run.step(i);
  };
  const auto work = [](const std::filesystem::path& directory) {
    const long moments = std::exchange(moments_left, never);
    SodRun run(directory, 1e9);
    page = std::numeric_limits<std::size_t>::max();
    moments_left = moments;
    run.step(190.0);
    run.step(191.0);
  };
  std::vector<Times> stages(3);
  for (int i = 0; i < 192; ++i)
    for (int stage = std::max(0, i - 189); stage < 3; ++stage)
      stages[static_cast<std::size_t>(stage)].push_back(i);
  EXPECT_GT(kill_everywhere(preparation, work, stages, 11), 200) << "all of them take a minute";
}

}  // namespace
}  // namespace drogue::run
