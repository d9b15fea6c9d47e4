#pragma once

#include <filesystem>
#include <string>

// Functions that make files survive a crash of the machine, and that swap folders in one step. They return the system's
// error message, empty on success, because the caller's message must name its own target.
namespace incise {

/// Syncs a file, or a folder's list of names, to the disk. If the file system does not support this (EINVAL), it counts
/// as done.
[[nodiscard]] std::string synced(const std::filesystem::path& path);

/// The same for a folder and everything below it; links are not followed.
[[nodiscard]] std::string synced_tree(const std::filesystem::path& folder);

enum class Exchange { IfPossible, Never };

/// Renames `folder` to `target`. An older folder there moves to `folder` if the file system can exchange two names in
/// one step, otherwise to `older`, which must not exist. `replaced` returns its new name; empty: there was none. If the
/// process is killed at any moment, the older or the new folder is at `target`; without an exchange, the older one may
/// be at `older` instead.
[[nodiscard]] std::string put_in_place(const std::filesystem::path& folder, const std::filesystem::path& target, const std::filesystem::path& older,
                                       std::filesystem::path& replaced, Exchange exchange = Exchange::IfPossible);

}  // namespace incise
