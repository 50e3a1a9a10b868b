#include "common/run/hdf5/shared_write.hpp"

#include <mpi.h>

#include <cerrno>

#include "common/run/files/io_error.hpp"

namespace drogue::run {
namespace {

std::vector<int> as_integers(const std::vector<std::uint64_t>& values) {
  return {values.begin(), values.end()};
}

/// Error of the system that is nearest to one of MPI; 0 for success.
int system_error(int error) {
  if (error == MPI_SUCCESS) return 0;
  int kind = MPI_ERR_OTHER;
  MPI_Error_class(error, &kind);
  if (kind == MPI_ERR_NO_SPACE) return ENOSPC;
  if (kind == MPI_ERR_QUOTA) return EDQUOT;
  if (kind == MPI_ERR_NO_SUCH_FILE) return ENOENT;
  return kind == MPI_ERR_ACCESS || kind == MPI_ERR_READ_ONLY ? EACCES : EIO;
}

/// Throws on all ranks if `error` is one on any.
void check_collectively(int error, const std::filesystem::path& file) {
  int worst = system_error(error);
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (worst != 0) throw io_failure("write", file, worst);
}

}  // namespace

void write_parts(const std::filesystem::path& file, std::uint64_t offset, const ArrayPart& part,
                 std::span<const double> values) {
  MPI_File handle = MPI_FILE_NULL;
  // Files return errors, other objects of MPI end the program.
  check_collectively(MPI_File_open(MPI_COMM_WORLD, file.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &handle),
                     file);
  MPI_Datatype place = MPI_DATATYPE_NULL;
  MPI_Type_create_subarray(static_cast<int>(part.whole.size()), as_integers(part.whole).data(),
                           as_integers(part.extent).data(), as_integers(part.begin).data(), MPI_ORDER_C,
                           MPI_DOUBLE, &place);
  MPI_Type_commit(&place);
  int error =
      MPI_File_set_view(handle, static_cast<MPI_Offset>(offset), MPI_DOUBLE, place, "native", MPI_INFO_NULL);
  MPI_Status status;
  // Not MPI_File_write_all: that of Open MPI 4.1 succeeds, with the whole count, where the system refuses.
  const int written =
      MPI_File_write(handle, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, &status);
  if (error == MPI_SUCCESS) error = written;
  int count = 0;
  if (error == MPI_SUCCESS && MPI_Get_count(&status, MPI_DOUBLE, &count) == MPI_SUCCESS &&
      count != static_cast<int>(values.size()))
    error = MPI_ERR_NO_SPACE;
  const int closed = MPI_File_close(&handle);
  MPI_Type_free(&place);
  check_collectively(error == MPI_SUCCESS ? closed : error, file);
}

}  // namespace drogue::run
