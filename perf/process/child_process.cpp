#include "perf/process/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/program/failure.hpp"
#include "common/run/files/temporary_folder.hpp"
#include "kernels/device/host_cores.hpp"

namespace drogue::perf {

namespace {

/// Descriptors and folder of a child.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&_actions); }
  ~FileActions() { posix_spawn_file_actions_destroy(&_actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;

  void enter(const std::filesystem::path& folder) {
    posix_spawn_file_actions_addchdir_np(&_actions, folder.c_str());
  }
  void open(int descriptor, const std::filesystem::path& file, int flags) {
    posix_spawn_file_actions_addopen(&_actions, descriptor, file.c_str(), flags, 0666);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &_actions; }

 private:
  posix_spawn_file_actions_t _actions{};
};

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

int run_child(const std::vector<std::string>& words, const std::filesystem::path& folder,
              const std::filesystem::path& log, bool log_output) {
  FileActions actions;
  actions.open(0, "/dev/null", O_RDONLY);
  actions.open(1, log_output ? log : "/dev/null", O_WRONLY | O_CREAT | O_APPEND);
  actions.open(2, log, O_WRONLY | O_CREAT | O_APPEND);
  actions.enter(folder);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const device::UnboundThread unbound;
  const int error = posix_spawnp(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ);
  if (error != 0)
    throw Failure(ExitCode::io_error, "'" + words[0] + "' cannot be started: " + std::strerror(error));
  return wait_for(child);
}

namespace {

/// Reason of a failure in a log.
struct Reason {
  std::string sentence;     ///< of the program, else the first paragraph, without the frame of a launcher
  bool of_program = false;  ///< the sentence is that of a program of this suite
  bool as_root = false;     ///< a launcher mentions that it runs as root
};

Reason reason_in(const std::filesystem::path& log) {
  std::ifstream file(log);
  Reason reason;
  bool ended = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("drogue-") && line.find(": ") != std::string::npos)
      return {line, true, reason.as_root};
    reason.as_root = reason.as_root || line.find("run as root") != std::string::npos;
    const bool has_words = std::ranges::any_of(line, [](unsigned char c) { return std::isalpha(c) != 0; });
    if (has_words && !ended)
      reason.sentence += (reason.sentence.empty() ? "" : " ") + line.substr(line.find_first_not_of(" \t"));
    ended = ended || (!has_words && !reason.sentence.empty());
  }
  if (reason.sentence.ends_with(':')) reason.sentence.back() = '.';
  return reason;
}

/// True for a code with which a program of this suite prints a sentence, and which a launcher passes on.
bool has_sentence(int status) {
  constexpr ExitCode codes[] = {ExitCode::usage, ExitCode::invalid_scene, ExitCode::numerical_failure,
                                ExitCode::io_error, ExitCode::no_backend};
  return std::ranges::any_of(codes, [&](ExitCode code) { return static_cast<int>(code) == status; });
}

/// How a run ended that gave no code of its own, in words.
std::string describe_end(int status) {
  if (status == 0 || status == static_cast<int>(ExitCode::verification_failed))
    return "it ended without a result";
  if (status > 128) return "signal " + std::to_string(status - 128) + " ended it";
  return "it ended with code " + std::to_string(status);
}

}  // namespace

Failure failed_run(const std::string& what, int status, const std::filesystem::path& log) {
  const Reason reason = reason_in(log);
  const std::string failed = what + " failed: ";
  // 130 is that of a signal from the keyboard, whoever prints a sentence.
  const bool interrupted = status == static_cast<int>(ExitCode::interrupted) && !reason.sentence.empty();
  if (interrupted || (has_sentence(status) && reason.of_program))
    return {static_cast<ExitCode>(status), failed + reason.sentence};
  if (!reason.of_program && reason.as_root)
    return {ExitCode::usage,
            failed +
                "mpirun refuses to run as root; run as another user, or, in a container, set "
                "OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  if (!reason.of_program && reason.sentence.find("not enough slots") != std::string::npos)
    return {ExitCode::usage,
            failed +
                "mpirun has fewer slots than ranks, by default one per core; take fewer ranks, or let them "
                "share cores by OMPI_MCA_rmaps_base_oversubscribe=1, with Open MPI 5 "
                "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe; --ranks of benchmark and --most of "
                "table set the number"};
  // A launcher that starts nothing ends with 1, which no program of this suite does.
  if (status == 1 && !reason.sentence.empty()) return {ExitCode::usage, failed + reason.sentence};
  const std::string end = describe_end(status);
  return {ExitCode::io_error, failed + (reason.sentence.empty() ? end : end + ": " + reason.sentence)};
}

void require_launcher(int ranks) {
  std::istringstream folders(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  bool found = false;
  for (std::string folder; std::getline(folders, folder, ':');)
    found = found || std::filesystem::exists(std::filesystem::path(folder) / "mpirun");
  if (!found)
    throw Failure(ExitCode::no_backend, "several ranks need mpirun, and no folder of PATH holds it");
  const run::TemporaryFolder folder("drogue-launcher");
  const std::filesystem::path log = folder.path() / "log";
  std::vector<std::string> words = launcher_words(ranks, 1);
  words.emplace_back("true");
  if (const int status = run_child(words, folder.path(), log, true); status != 0)
    throw failed_run("a run on " + std::to_string(ranks) + " ranks", status, log);
}

std::vector<std::string> launcher_words(int ranks, int threads) {
  std::vector<std::string> words = {"mpirun", "-n", std::to_string(ranks)};
  // Otherwise Open MPI binds each of few ranks to one core.
  if (threads > 1) words.insert(words.end(), {"--bind-to", "none"});
  return words;
}

std::filesystem::path program_file(const std::string& program) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / program;
}

std::vector<std::string> program_words(const std::vector<std::string>& launcher, int threads,
                                       const std::string& program, const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& settings) {
  std::vector<std::string> words = {"env", "OMP_NUM_THREADS=" + std::to_string(threads)};
  words.insert(words.end(), settings.begin(), settings.end());
  words.insert(words.end(), launcher.begin(), launcher.end());
  words.push_back(program_file(program).string());
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

}  // namespace drogue::perf
