#pragma once

#include <filesystem>

namespace incise {

/// Removes from `folder` the temporary files and folders that killed calls of write_atomically and AtomicFolder left
/// there. An older folder that a killed AtomicFolder had moved aside gets its name back if nothing replaced it.
/// Skips names that are still locked, names of other processes that still run on this machine, and whatever it cannot
/// remove. Names with this process's number are taken for those of an earlier process, so call it before writing
/// anything into `folder`.
void remove_abandoned_temporaries(const std::filesystem::path& folder);

}  // namespace incise
