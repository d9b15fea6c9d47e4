#pragma once

#include <filesystem>
#include <string>

// What makes files outlive a crash of the machine, and folders change places in one step. Messages name the caller's target: these functions
// return what went wrong in the system's words, empty where nothing did.
namespace incise {

/// Brings a file or a folder's list of names to the disk. What a file system cannot bring there (EINVAL) counts as done.
[[nodiscard]] std::string synced(const std::filesystem::path& path);

/// The same for a folder and everything below it; links are not followed.
[[nodiscard]] std::string synced_tree(const std::filesystem::path& folder);

enum class Exchange { IfPossible, Never };

/// Puts a folder at a name. An older folder there is moved to `older` (made by nobody yet) or, where the file system can exchange two names in
/// one step, to `folder`; `replaced` says which it is, empty where there was none. Killed at any moment, the older or the new folder is at the
/// name, but for Exchange::Never, where for one moment the older one has the name `older`.
[[nodiscard]] std::string put_in_place(const std::filesystem::path& folder, const std::filesystem::path& target, const std::filesystem::path& older,
                                       std::filesystem::path& replaced, Exchange exchange = Exchange::IfPossible);

}  // namespace incise
