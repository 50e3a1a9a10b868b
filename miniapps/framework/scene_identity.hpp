#pragma once

#include <string>

namespace drogue::framework {

/// Data that must agree between a run and its continuation.
struct SceneIdentity {
  std::string keys;      ///< the scene as `scene::print` prints it, with neutral values of what may change
  std::string meshes{};  ///< contents of its mesh files
};

/// Fingerprint of an identity, for restart.h5. Does not throw.
std::string fingerprint(const SceneIdentity& identity);

/// First difference between the scene of a restart file and the present one, for messages: `flow.time was
/// "rk3" and is "ab2"`, with the number of other keys that differ. Long values are left out. Empty if the
/// identities are equal. Does not throw.
std::string first_difference(const SceneIdentity& earlier, const SceneIdentity& present);

}  // namespace drogue::framework
