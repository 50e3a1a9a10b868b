#include "common/program/mpi_guard.hpp"

#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "common/program/failure.hpp"

namespace drogue {
namespace {

std::optional<int> environment_number(const char* name) {
  const char* text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  const std::string_view digits = text;
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || value < 0) return std::nullopt;
  return value;
}

/// Reads rank and number of ranks from environment variables of a launcher.
std::optional<LaunchedRank> from_environment(const char* rank_name, const char* ranks_name) {
  const std::optional<int> ranks = environment_number(ranks_name);
  if (!ranks || *ranks < 1) return std::nullopt;
  return LaunchedRank{environment_number(rank_name).value_or(0), *ranks};
}

}  // namespace

LaunchedRank launched_rank() {
  if (const auto place = from_environment("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE")) return *place;
  if (const auto place = from_environment("PMI_RANK", "PMI_SIZE")) return *place;
  // srun with PMIx: only a task has PMIX_RANK, while the job script has SLURM_NTASKS as well.
  if (environment_number("PMIX_RANK"))
    return from_environment("PMIX_RANK", "SLURM_NTASKS").value_or(LaunchedRank{});
  return {};
}

void require_one_rank() {
  const int ranks = launched_rank().ranks;
  if (ranks == 1) return;
  throw Failure(ExitCode::usage,
                "there is no parallel solver: start this program without mpirun or with one rank, not " +
                    std::to_string(ranks));
}

}  // namespace drogue
