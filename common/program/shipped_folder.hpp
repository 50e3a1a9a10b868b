#pragma once

#include <filesystem>
#include <string>

namespace drogue {

/// Folder `share/drogue/NAME` beside the installed or bundled program, else `source_folder` in the source
/// tree. Does not throw.
[[nodiscard]] std::filesystem::path find_shipped_folder(const std::string& name,
                                                        const std::filesystem::path& source_folder);

}  // namespace drogue
