#pragma once

#include <filesystem>

namespace incise {

/// Removes from `folder` what writers that were killed left there: files and folders under the temporary names of
/// write_atomically and AtomicFolder. What belongs to another process that still runs on this machine stays; this
/// process's own names are taken for those of an earlier one with its number, so it is to be called before anything is
/// written there. What cannot be removed stays as well.
void remove_abandoned_temporaries(const std::filesystem::path& folder);

}  // namespace incise
